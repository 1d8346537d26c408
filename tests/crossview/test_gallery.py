"""The gallery: every case solves, and says what the figure it stands for is to show."""

from __future__ import annotations

import json
from functools import cache

import numpy as np
import pytest
import pyvista as pv

from crossview import gallery
from crossview.gallery import find_case
from crossview.pipeline import Solution, solve_case
from solvers.progress import run

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


@pytest.mark.parametrize("name", gallery.names())
def test_a_case_solves_and_is_valid_unless_it_shows_that_it_is_not(name):
    solution = solved(name)
    assert find_case(name).title
    assert solution.field.index_sum == solution.field.index_required
    assert solution.field.max_closing_error < 1e-9
    assert solution.valid == (name not in NOT_ISOTROPIC)
    valid = name in INTEGRABLE or name not in NOT_ISOTROPIC
    assert (solution.verdict.status == "valid") == valid
    if name in VALENCES:
        assert {s.valence for s in solution.singularities} == VALENCES[name]


def test_the_four_of_the_disk_align_the_field_with_the_circle():
    assert np.abs(np.degrees(solved("disk-4").field.boundary_misalignment)).max() < 1e-6


def test_the_annuli_are_near_and_far_from_valid():
    near, far = (
        np.abs(np.degrees(solved(f"annulus-{n}").holonomy_defects)) for n in ("near", "far")
    )
    assert 0.01 < near.max() < 5 < 30 < far.max()


@pytest.mark.parametrize("name", sorted(INTEGRABLE))
def test_anisotropic_cases_are_aligned_and_integrable(name):
    field = solved(name).field
    assert field.method == "anisotropic"
    assert field.energy <= 1e-10
    assert np.abs(field.boundary_misalignment).max() < 1e-9


@pytest.mark.parametrize("name", sorted(MERELY_ALIGNED))
def test_theta_imposed_is_aligned_and_not_integrable(name):
    solution = solved(name)
    assert solution.field.method == "aligned"
    assert np.abs(solution.field.boundary_misalignment).max() < 1e-9
    assert solution.verdict.status == "suspect"
    # gallery: of the order of 0.1 to 0.5 near a valid configuration
    if name != "annulus-far-aligned":
        assert 0.1 < solution.field.energy < 0.6


def test_pairs_of_cases_differ_in_method_only():
    pairs = [("annulus-near", "annulus-near-aligned"), ("annulus-far", "annulus-far-aligned")]
    pairs += [("suboptimal-a", "suboptimal-b"), ("suboptimal-a", "suboptimal-c")]
    for one, other in pairs:
        first, second = find_case(one), find_case(other)
        assert first.singularities == second.singularities
        assert (first.surface, first.options) == (second.surface, second.options)


def test_the_square_is_its_constant_solution():
    field = solved("square").field
    assert max(np.abs(field.H1).max(), np.abs(field.H2).max()) < 1e-8
    # along x or y: a cross is the same after a quarter turn
    assert np.abs(field.u[:, 0] * field.u[:, 1]).max() < 1e-8


def test_the_torus_is_told_to_be_impossible():
    assert solved("torus-35").verdict.status == "impossible"


def test_the_commands_name_and_draw_the_cases(crossview, tmp_path):
    listed = crossview("gallery", "--list").out.splitlines()
    assert [line.split()[0] for line in listed] == list(gallery.names())
    assert len(listed) >= 10
    ran = crossview("gallery", "square", "disk-4", "-o", tmp_path)
    assert ran.status == 0, ran.err
    assert [line.partition(":")[0] for line in ran.out.splitlines()] == ["square", "disk-4"]
    for name in ("square", "disk-4"):
        report = json.loads((tmp_path / name / "report.json").read_text())
        assert report["isotropically_valid"]
        assert pv.read(tmp_path / name / "figure.png").dimensions[:2] == (1600, 1200)
