from pathlib import Path

import numpy as np

from crossview.cases.model import Case
from crossview.session.commands import AddSingularities
from crossview.session.document import Document
from crossview.session.opening import Opening, open_target
from solvers.progress import run
from solvers.singularities import Singularity


def test_square_has_four_corners_and_keeps_its_budget() -> None:
    square = Document.from_case("square", Case.from_json({"surface": {"builtin": "square"}}))
    assert sorted(square.corners.values()) == [1, 1, 1, 1]
    assert square.budget.satisfied


def test_editing_shares_the_surface_and_the_corners() -> None:
    square = Document.from_case("square", Case.from_json({"surface": {"builtin": "square"}}))
    place = square.surface.closest_point((0.3, 0.4, 0.0))
    edited = AddSingularities((Singularity(place, 3),)).apply(square)
    assert edited.surface is square.surface
    assert edited.corners is square.corners
    assert edited.budget.missing == -1
    assert square.singularities == ()


def test_a_saved_document_opens_as_itself(tmp_path: Path) -> None:
    disk = Document.from_case("disk", Case.from_json({"surface": {"builtin": "disk"}}))
    places = [disk.surface.closest_point(p) for p in ((0.5, 0.1, 0.0), (-0.4, 0.2, 0.0))]
    edited = disk.with_singularities(
        [Singularity(places[0], 3), Singularity(places[1], 6, locked=True)]
    )
    path = tmp_path / "disk.json"
    edited.to_case().save(path)
    again = run(open_target(Opening(str(path))))
    assert again.name == "disk"
    assert [(s.valence, s.locked) for s in again.singularities] == [(3, False), (6, True)]
    np.testing.assert_allclose(
        again.surface.positions([s.point for s in again.singularities]),
        edited.surface.positions([s.point for s in edited.singularities]),
        atol=1e-12,
    )
