"""Which guide lines are shown, and a point kept on one."""

import numpy as np
import pytest

from crossview.cases.model import Case
from crossview.session.document import Document
from crossview.session.guide_curves import Guidance
from crossview.session.live import LiveEdit, prepare
from solvers.progress import run

TOLERANCE = np.radians(0.01)


def edit(builtin: dict[str, object], *placed: tuple[list[float], int]) -> LiveEdit:
    singularities = [{"position": p, "valence": v} for p, v in placed]
    case = Case.from_json({"surface": builtin, "singularities": singularities})
    document = Document.from_case("case", case)
    return LiveEdit.start(document, run(prepare(document)))


def polar(radius: float, degrees: float) -> list[float]:
    return [radius * np.cos(np.radians(degrees)), radius * np.sin(np.radians(degrees)), 0.0]


@pytest.fixture(scope="module")
def annulus() -> LiveEdit:
    return edit({"builtin": "annulus", "inner": 0.4}, (polar(0.6, 20), 3), (polar(0.8, 80), 5))


def test_an_open_condition_has_a_strong_line_and_the_present_one(annulus: LiveEdit) -> None:
    thin, thick = run(Guidance(annulus, 0).curves(TOLERANCE, None))
    assert (thin.strong, thick.strong) == (False, True)
    for curve, degrees in ((thin, 20), (thick, 80)):
        angles = np.degrees(np.arctan2(curve.ends[..., 1], curve.ends[..., 0]))
        assert np.abs(angles - degrees).max() < 0.1


def test_a_closed_condition_has_one_thin_line() -> None:
    valid = edit({"builtin": "annulus", "inner": 0.4}, (polar(0.6, 80), 3), (polar(0.8, 80), 5))
    (line,) = run(Guidance(valid, 0).curves(np.radians(0.1), None))
    assert not line.strong


def test_of_several_conditions_each_has_a_line_and_the_one_pointed_at_is_alone() -> None:
    torus = edit(
        {"builtin": "torus", "n": 36},
        *(([1.4, 0, 0], 3), ([0, 1.4, 0], 3), ([-1.4, 0, 0], 5), ([0, -1, 0.4], 5)),
    )
    lines = run(Guidance(torus, 1).curves(TOLERANCE, None))
    assert [line.condition for line in lines] == [0, 1]
    pointed = run(Guidance(torus, 1).curves(TOLERANCE, 1))
    assert {line.condition for line in pointed} == {1}
    assert pointed[-1].strong
    np.testing.assert_array_equal(pointed[-1].ends, lines[1].ends)


def test_one_to_be_added_has_only_the_lines_on_which_conditions_close(annulus: LiveEdit) -> None:
    (line,) = run(Guidance(annulus, 1, placed=False).curves(TOLERANCE, None))
    assert line.strong


def test_a_point_is_kept_on_the_ray_that_closes(annulus: LiveEdit) -> None:
    surface = annulus.base.surface
    for condition in (None, 0):
        point = surface.closest_point(polar(0.7, 60))
        kept = surface.position(Guidance(annulus, 0).kept(condition, point))
        assert np.degrees(np.arctan2(kept[1], kept[0])) == pytest.approx(80, abs=0.1)
        assert np.linalg.norm(kept) == pytest.approx(0.7, abs=0.1)


def test_a_sphere_has_no_lines_and_keeps_nothing() -> None:
    sphere = edit({"builtin": "sphere"}, ([0, 0, 1], 3))
    guidance = Guidance(sphere, 0)
    assert run(guidance.curves(TOLERANCE, None)) == ()
    point = sphere.base.surface.closest_point([1, 0, 0])
    assert guidance.kept(None, point) == point
