"""The gallery: every case solves, and says what the figure it stands for is to show."""

from __future__ import annotations

import json
from collections import Counter
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import pyvista as pv

from crossview.cases import gallery
from crossview.cases.gallery import find_case
from crossview.export.report import report
from crossview.workflow.layout import layout, layout_soon
from crossview.workflow.pipeline import Solution, solve_case
from crossview.workflow.quads import MeshOptions, quads_of
from solvers.layouts.errors import LayoutError
from solvers.layouts.layout import QuadLayout
from solvers.progress import run
from solvers.quads.quadmesh import QuadMesh
from tests.command_line import Crossview

NOT_ISOTROPIC = {
    "annulus-far",
    "annulus-far-aligned",
    "annulus-near",
    "annulus-near-aligned",
    "suboptimal-a",
    "suboptimal-b",
    "suboptimal-c",
    "torus-35",
}
INTEGRABLE = {"annulus-far", "annulus-near", "suboptimal-c", "square"}
MERELY_ALIGNED = {"annulus-far-aligned", "annulus-near-aligned", "suboptimal-b"}
VALENCES = {
    "teaser-a": {3, 5},
    "teaser-b": {3, 6},
    "teaser-c": {3, 8},
    "disk-4": {3},
    "sphere-cube": {3},
    "sphere-anticube": {3},
    "square": set(),
    "annulus-near": {3, 5},
    "annulus-far": {3, 5},
    "torus-35": {3, 5},
}


@cache
def solved(name: str) -> Solution:
    (solution,) = run(solve_case(find_case(name)))
    return solution


@cache
def meshed(name: str) -> tuple[Solution, QuadLayout, QuadMesh]:
    return run(quads_of(solved(name), MeshOptions(target_quads=1500)))


def laid_out(name: str) -> dict[str, Any]:
    """What the report tells of separatrices, exact where there is a layout."""
    solution = solved(name)
    told: dict[str, Any] = report(solution, run(layout_soon(solution)))["layout"]
    return told


def has_quads(name: str) -> bool:
    return name in INTEGRABLE or name not in NOT_ISOTROPIC


@pytest.mark.parametrize("name", gallery.names())
def test_a_case_solves_and_is_valid_unless_it_shows_that_it_is_not(name: str) -> None:
    solution = solved(name)
    assert find_case(name).title
    assert solution.field.index_sum == solution.field.index_required
    assert solution.field.max_closing_error < 1e-9
    assert solution.valid == (name not in NOT_ISOTROPIC)
    assert (solution.verdict.status == "valid") == has_quads(name)
    if name in VALENCES:
        assert {s.valence for s in solution.singularities} == VALENCES[name]


def test_the_four_of_the_disk_align_the_field_with_the_circle() -> None:
    assert np.abs(np.degrees(solved("disk-4").field.boundary_misalignment)).max() < 1e-6


def test_the_annuli_are_near_and_far_from_valid() -> None:
    near, far = (
        np.abs(np.degrees(solved(f"annulus-{n}").holonomy_defects)) for n in ("near", "far")
    )
    assert 0.01 < near.max() < 5 < 30 < far.max()


@pytest.mark.parametrize("name", sorted(INTEGRABLE))
def test_anisotropic_cases_are_aligned_and_integrable(name: str) -> None:
    field = solved(name).field
    assert field.method == "anisotropic"
    assert field.energy <= 1e-10
    assert np.abs(field.boundary_misalignment).max() < 1e-9


@pytest.mark.parametrize("name", sorted(MERELY_ALIGNED))
def test_theta_imposed_is_aligned_and_not_integrable(name: str) -> None:
    solution = solved(name)
    assert solution.field.method == "aligned"
    assert np.abs(solution.field.boundary_misalignment).max() < 1e-9
    assert solution.verdict.status == "not found"
    # gallery: of the order of 0.1 to 0.5 near a valid configuration
    if name != "annulus-far-aligned":
        assert 0.1 < solution.field.energy < 0.6


def test_pairs_of_cases_differ_in_method_only() -> None:
    pairs = [("annulus-near", "annulus-near-aligned"), ("annulus-far", "annulus-far-aligned")]
    pairs += [("suboptimal-a", "suboptimal-b"), ("suboptimal-a", "suboptimal-c")]
    for one, other in pairs:
        first, second = find_case(one), find_case(other)
        assert first.singularities == second.singularities
        assert (first.surface, first.options) == (second.surface, second.options)


def test_the_square_is_its_constant_solution() -> None:
    field = solved("square").field
    assert max(np.abs(field.H1).max(), np.abs(field.H2).max()) < 1e-8
    # along x or y: a cross is the same after a quarter turn
    assert np.abs(field.u[:, 0] * field.u[:, 1]).max() < 1e-8


def test_the_torus_is_told_to_be_impossible() -> None:
    assert solved("torus-35").verdict.status == "impossible"


@pytest.mark.parametrize("name", gallery.names())
def test_a_case_has_quads_if_its_field_is_aligned_and_integrable(name: str) -> None:
    if not has_quads(name):
        with pytest.raises(LayoutError):
            run(layout(solved(name)))
        return
    solution, _, mesh = meshed(name)
    imposed = Counter(s.valence for s in solution.singularities)
    assert mesh.irregular == imposed
    corners = Counter(2 - index for index in solution.field.corners.values())
    assert mesh.corners == {valence: n for valence, n in corners.items() if valence != 2}
    assert mesh.euler_characteristic == solution.surface.euler_characteristic
    assert mesh.scaled_jacobian.min() > 0.25
    assert mesh.scaled_jacobian.mean() > 0.95
    assert mesh.max_distance_to_surface < 1e-9
    assert abs(mesh.n_quads - 1500) < 150


# the sum over singularities of their valences is that of the ends of separatrices
@pytest.mark.parametrize(
    ("name", "patches", "arcs"),
    [("sphere-cube", 6, 12), ("disk-4", 5, 8), ("teaser-a", 15, 15), ("square", 1, 0)],
)
def test_layouts_are_those_of_the_figures(name: str, patches: int, arcs: int) -> None:
    made = report(*meshed(name))["layout"]
    assert (made["patches"], made["separatrices"]) == (patches, arcs)
    assert (made["conforming"], made["t_junctions"], made["flips"]) == (True, 0, 0)


def test_the_teasers_have_three_different_conforming_layouts() -> None:
    made = [report(*meshed(f"teaser-{letter}"))["layout"] for letter in "abc"]
    assert [m["conforming"] for m in made] == [True] * 3
    assert len({(m["patches"], m["separatrices"]) for m in made}) == 3


def test_the_far_annulus_loses_its_t_junctions() -> None:
    start, end = (laid_out(f"annulus-far{of}") for of in ("-aligned", ""))
    assert end["t_junctions"] < start["t_junctions"]
    exact = report(*meshed("annulus-far"))["layout"]
    assert exact["t_junctions"] < start["t_junctions"]


def test_the_suboptimal_plate_shows_what_each_method_mends() -> None:
    a, b, c = (laid_out(f"suboptimal-{letter}") for letter in "abc")
    assert (a["misaligned_boundaries"], b["misaligned_boundaries"]) == (2, 0)
    assert a["t_junctions"] > 0
    assert b["t_junctions"] > 0
    assert (c["misaligned_boundaries"], c["t_junctions"]) == (0, 0)
    assert report(*meshed("suboptimal-c"))["layout"]["conforming"]


def test_the_commands_name_and_draw_the_cases(crossview: Crossview, tmp_path: Path) -> None:
    listed = crossview("gallery", "--list").out.splitlines()
    assert [line.split()[0] for line in listed] == list(gallery.names())
    assert len(listed) >= 10
    ran = crossview("gallery", "square", "disk-4", "-o", tmp_path)
    assert ran.status == 0, ran.err
    told = [line.partition(":")[0] for line in ran.out.splitlines()]
    assert told == ["square", "square", "disk-4", "disk-4"]  # the field, then the quads
    for name in ("square", "disk-4"):
        said = json.loads((tmp_path / name / "report.json").read_text())
        assert said["isotropically_valid"]
        assert said["quads"]["quads"] == pv.read(tmp_path / name / "quads.vtk").n_cells
        for picture in ("figure.png", "quads.png"):
            assert pv.read(tmp_path / name / picture).dimensions[:2] == (1600, 1200)
