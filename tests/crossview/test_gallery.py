"""The gallery: every case solves, and says what the figure it stands for is to show."""

from __future__ import annotations

import json

import numpy as np
import pytest
import pyvista as pv

from crossview import gallery
from crossview.gallery import find_case
from crossview.pipeline import Solution, solve_case
from solvers.progress import run

INVALID = {"annulus-far", "annulus-near", "suboptimal-a", "torus-35"}
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


def solved(name: str) -> Solution:
    (solution,) = run(solve_case(find_case(name)))
    return solution


@pytest.mark.parametrize("name", gallery.names())
def test_a_case_solves_and_is_valid_unless_it_shows_that_it_is_not(name):
    solution = solved(name)
    assert find_case(name).title
    assert solution.field.index_sum == solution.field.index_required
    assert solution.field.max_closing_error < 1e-9
    assert solution.valid == (name not in INVALID)
    if name in VALENCES:
        assert {s.valence for s in solution.singularities} == VALENCES[name]


def test_the_four_of_the_disk_align_the_field_with_the_circle():
    assert np.abs(np.degrees(solved("disk-4").field.boundary_misalignment)).max() < 1e-6


def test_the_annuli_are_near_and_far_from_valid():
    near, far = (
        np.abs(np.degrees(solved(f"annulus-{n}").holonomy_defects)) for n in ("near", "far")
    )
    assert 0.01 < near.max() < 5 < 30 < far.max()


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
