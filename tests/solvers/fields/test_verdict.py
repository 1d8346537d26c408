"""One set of limits for every judgement: what is valid is never refused."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from solvers.fields.aligned import AlignedField, IntegratedField, aligned_field
from solvers.fields.crossfield import CrossField
from solvers.fields.integrable import anisotropic_field
from solvers.fields.pieces import field_existence
from solvers.fields.prepared import prepare
from solvers.fields.verdict import NEARLY_INTEGRABLE, Limits, judge
from solvers.layouts.errors import LayoutError
from solvers.layouts.layout import quad_layout
from solvers.primitives import annulus, torus
from solvers.progress import run
from solvers.remedies import MakeValid, UseMethod
from solvers.singularities.budget import Singularity
from solvers.singularities.remedies import ChangeTurns
from solvers.singularities.theorems import FLAT_ANNULUS, FLAT_TORUS


def turned_pairs(off: float) -> AlignedField:
    """Four valence 3, four valence 5 each `off` degrees further: that is the defect."""
    surface = annulus(inner=0.4, n=48)
    configuration = []
    for radius, turn, valence in ((0.8, 0.0, 3), (0.6, off, 5)):
        for angle in np.radians(90 * np.arange(4) + turn):
            place = [radius * np.cos(angle), radius * np.sin(angle), 0.0]
            configuration.append(Singularity(surface.closest_point(place), valence))
    return aligned_field(prepare(surface, configuration, refine=1))


@pytest.fixture(scope="module")
def field() -> CrossField:
    return run(anisotropic_field(turned_pairs(12.0))).field


def with_energy(field: CrossField, energy: float) -> CrossField:
    everywhere = np.full(field.surface.n_faces, energy**2 / field.surface.area)
    return replace(field, error_density=everywhere, on_working=None)


def test_of_a_field_that_does_not_close_no_map_is_found(field: CrossField) -> None:
    assert judge(field, 0).status == "valid"
    for error in (0.72, 1e-5, np.nan):
        verdict = judge(replace(field, max_closing_error=error), 0, limits=Limits(angle=1.0))
        assert (verdict.status, verdict.refused) == ("not found", True)
    assert "41 degrees" in judge(replace(field, max_closing_error=0.72)).reason


@pytest.mark.parametrize("measure", ["defects", "boundary_misalignment", "feature_misalignment"])
@pytest.mark.parametrize("tolerance", [0.01, 0.1, 1.0])
def test_what_is_off_by_the_tolerance_is_refused(
    field: CrossField, measure: str, tolerance: float
) -> None:
    limits = Limits(float(np.radians(tolerance)))
    for share, status in ((0.99, "valid"), (1.01, "not found"), (np.nan, None)):
        off: dict[str, Any] = {measure: np.array([0.0, -share * limits.angle])}
        verdict = judge(replace(field, **off), 0, limits=limits)
        if status is not None:
            assert verdict.status == status
        assert verdict.refused == (share != 0.99)


def test_an_iterate_that_has_not_converged_is_not_valid(field: CrossField) -> None:
    """However small its E is: what is left may be all that the configuration is off by."""
    assert judge(field, 0).status == "valid"
    stopped = replace(field, convergence=replace(field.convergence, converged=False))
    verdict = judge(stopped, 0)
    assert (verdict.status, verdict.refused) == ("not found", False)
    assert "not converged" in verdict.reason


def test_energy_is_judged_in_three_steps(field: CrossField) -> None:
    limits = Limits(energy=1e-3)
    for energy, status, refused in (
        (0.99e-3, "valid", False),
        (1.01e-3, "not found", False),
        (0.99 * NEARLY_INTEGRABLE, "not found", False),
        (1.01 * NEARLY_INTEGRABLE, "not found", True),
    ):
        verdict = judge(with_energy(field, energy), 0, limits=limits)
        assert (verdict.status, verdict.refused) == (status, refused)
    wide = Limits(energy=2 * NEARLY_INTEGRABLE)
    assert judge(with_energy(field, 1.5 * NEARLY_INTEGRABLE), 0, limits=wide).status == "valid"


@pytest.mark.parametrize("off", [0.3, 3.0, 20.0])
def test_the_energy_that_a_surface_allows_is_that_of_the_defects_it_allows(off: float) -> None:
    """E^2 of the aligned field is r^2 2 pi / log(outer / inner) on an annulus."""
    aligned = turned_pairs(off)
    defect = float(np.abs(aligned.isotropic.defects[0]))
    energy = IntegratedField(aligned, aligned.start).field.energy
    for share, valid in ((1.01, True), (0.99, False)):
        limits = Limits.on(aligned.solver.holonomy, share * defect)
        assert (energy <= limits.energy) == valid
    assert energy == pytest.approx(defect * np.sqrt(2 * np.pi / np.log(1 / 0.4)), rel=0.01)


def test_a_layout_is_refused_with_the_verdicts_words_and_made_where_it_allows() -> None:
    aligned = turned_pairs(1.0)
    start = IntegratedField(aligned, aligned.start)
    assert start.field.energy > NEARLY_INTEGRABLE
    with pytest.raises(LayoutError, match="not integrable") as refused:
        run(quad_layout(start))
    assert refused.value.what == judge(start.field).reason.rstrip(".")
    wide = Limits.on(aligned.solver.holonomy, float(np.radians(1.2)))
    made = run(quad_layout(start, judge(start.field, limits=wide)))
    assert made.inverted == 0


def test_without_a_case_a_hundredth_of_a_degree_and_rounding_are_allowed(field: CrossField) -> None:
    for degrees, status in ((0.0095, "valid"), (0.0105, "not found")):
        assert judge(replace(field, defects=np.radians([degrees])), 0).status == status
    for energy, status in ((1e-12, "valid"), (1e-7, "not found")):
        assert judge(with_energy(field, energy), 0).status == status


def test_crosses_that_differ_by_what_rounding_leaves_on_real_surfaces_close(
    field: CrossField,
) -> None:
    assert judge(replace(field, max_closing_error=1e-8), 0).status == "valid"


def test_a_fifth_of_a_degree_on_an_annulus_is_as_good_as_none() -> None:
    """The mesh can tell no less: a layout is made."""
    for off, refused in ((0.19, False), (0.24, True)):
        aligned = turned_pairs(off)
        start = IntegratedField(aligned, aligned.start)
        assert start.field.max_closing_error < 1e-9
        verdict = judge(start.field)
        assert (verdict.status, verdict.refused) == ("not found", refused)
        assert bool(verdict.remedies) == refused


def test_quads_twenty_times_longer_than_wide_are_stretched(field: CrossField) -> None:
    for ratio, status in ((19.0, "valid"), (21.0, "stretched")):
        half = np.full((len(field.u), 3), np.log(ratio) / 2)
        stretched = replace(field, half_log_aspect=half, on_working=None)
        verdict = judge(stretched, 0)
        assert (verdict.status, verdict.refused) == (status, False)
    assert "factor of 21" in verdict.reason


def test_inverted_triangles_are_told_before_windings_and_those_before_aspect(
    field: CrossField,
) -> None:
    stretched = replace(field, half_log_aspect=np.full((len(field.u), 3), 2.0), on_working=None)
    inverted = judge(stretched, 1, wrong_windings=2)
    assert inverted.reason == "1 triangle is inverted in the seamless map."
    assert judge(field, 3).reason.startswith("3 triangles are inverted")
    wound = judge(stretched, 0, wrong_windings=2)
    assert "Around 2 vertices" in wound.reason
    assert judge(stretched, 0).status == "stretched"
    assert inverted.status == wound.status == "not found"
    assert "map is injective" in judge(field, 0).reason


def test_without_a_map_nothing_is_valid_and_nothing_refused(field: CrossField) -> None:
    stretched = replace(field, half_log_aspect=np.full((len(field.u), 3), 2.0), on_working=None)
    for unmapped in (judge(field), judge(stretched)):
        assert (unmapped.status, unmapped.refused) == ("not found", False)
        assert "no map was made" in unmapped.reason


def test_an_upright_map_that_winds_wrongly_around_a_vertex_is_not_valid(field: CrossField) -> None:
    for wrong, status in ((0, "valid"), (1, "not found"), (7, "not found")):
        assert judge(field, 0, wrong_windings=wrong).status == status
    assert "Around 1 vertex" in judge(field, 0, wrong_windings=1).reason


def test_what_topology_forbids_is_impossible_whatever_the_field_is_like() -> None:
    """The theorem is named, and what leads on; turns make a flat torus and cylinder impossible."""
    for surface, turns, theorem in (
        (torus(n=12), [1, 0], FLAT_TORUS),
        (annulus(n=24), [-1], FLAT_ANNULUS),
    ):
        aligned = aligned_field(prepare(surface, ()), turns)
        forced = IntegratedField(aligned, aligned.start).field
        verdict = judge(forced, 0, known=field_existence(aligned))
        assert (verdict.status, verdict.refused) == ("impossible", True)
        assert verdict.theorem is theorem
        (remedy,) = (r for r in verdict.remedies if isinstance(r, ChangeTurns))
        turned = [a + b for a, b in zip(turns, remedy.by, strict=True)]
        back = aligned_field(prepare(surface, ()), turned)
        found = IntegratedField(back, back.start).field
        assert judge(found, 0, known=field_existence(back)).status == "valid"
        with pytest.raises(LayoutError, match="without singularities the crosses"):
            run(quad_layout(IntegratedField(aligned, aligned.start)))


def test_defects_that_moving_closes_are_not_impossible() -> None:
    aligned = turned_pairs(20.0)
    verdict = judge(aligned.isotropic)
    assert verdict.status == "not found"
    assert [type(remedy) for remedy in verdict.remedies] == [MakeValid, UseMethod]
