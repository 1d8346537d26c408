"""The gallery: every case is as its table expects, and the table is of all cases."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from tempfile import mkdtemp
from typing import Any

import numpy as np
import pytest
import pyvista as pv

from crossview.cases.gallery import RESOURCES, Exhibit, exhibits, find_case, names
from crossview.cases.pictured import Pictured
from crossview.export.report import report
from crossview.studies.exhibition import performed
from crossview.studies.expectations import checks, compared_with
from crossview.studies.figures import figures
from crossview.studies.performing import State
from solvers.layouts.errors import LayoutError
from solvers.layouts.layout import QuadLayout
from solvers.progress import run
from tests.command_line import Crossview

EXHIBITS = {exhibit.case: exhibit for exhibit in exhibits()}


@cache
def state(name: str) -> State:
    return performed(EXHIBITS[name], Path(mkdtemp()))


@cache
def figures_of(name: str) -> dict[str, Any]:
    made = state(name)
    assert made.solution is not None
    return figures(report(made.solution, made.layout, made.quads))


def test_every_case_has_its_place_in_the_table() -> None:
    files = {path.stem for path in (RESOURCES / "gallery").glob("*.json")}
    assert sorted(names()) == sorted(files)
    assert len({each.sentence for each in exhibits()}) == len(files) >= 20


@pytest.mark.parametrize("exhibit", exhibits(), ids=lambda each: each.case)
def test_a_case_is_as_expected(exhibit: Exhibit) -> None:
    assert find_case(exhibit.case).title
    assert exhibit.sentence.endswith(".")
    others = {name: figures_of(name) for name in compared_with(exhibit.expect)}
    told = list(checks(exhibit.expect, figures_of(exhibit.case), others))
    assert [check for check in told if not check.passed] == []
    assert len(told) >= 4


@pytest.mark.parametrize("exhibit", exhibits(), ids=lambda each: each.case)
def test_a_case_without_quads_can_have_none(exhibit: Exhibit) -> None:
    from crossview.workflow.layout import layout

    made = state(exhibit.case)
    assert made.solution is not None
    if made.quads is not None:
        assert figures_of(exhibit.case)["quads.mean_scaled_jacobian"] > 0.9
        return
    with pytest.raises(LayoutError):
        run(layout(made.solution))


def test_the_annuli_are_near_and_far_from_valid() -> None:
    near, far = (
        abs(figures_of(f"annulus-{n}")["holonomy.defect_degrees.min"]) for n in ("near", "far")
    )
    assert 0.01 < near < 5 < 30 < far


def test_pairs_of_cases_differ_in_method_only() -> None:
    pairs = [("annulus-near", "annulus-near-aligned"), ("annulus-far", "annulus-far-aligned")]
    pairs += [("suboptimal-a", "suboptimal-b"), ("suboptimal-a", "suboptimal-c")]
    pairs += [("annulus-pair", "annulus-pair-aligned"), ("annulus-pair", "annulus-pair-stretched")]
    for one, other in pairs:
        first, second = find_case(one), find_case(other)
        assert first.singularities == second.singularities
        assert (first.surface, first.options) == (second.surface, second.options)


def test_the_square_is_its_constant_solution() -> None:
    solution = state("square").solution
    assert solution is not None
    # along x or y: a cross is the same after a quarter turn
    assert np.abs(solution.field.u[:, 0] * solution.field.u[:, 1]).max() < 1e-8


def test_the_teasers_have_three_different_layouts() -> None:
    layouts = [state(f"teaser-{letter}").layout for letter in "abc"]
    found = [made for made in layouts if isinstance(made, QuadLayout)]
    assert len({(made.patches, made.tmesh.n_arcs) for made in found}) == 3


def test_the_command_lists_draws_and_checks(crossview: Crossview, tmp_path: Path) -> None:
    listed = crossview("gallery", "--list").out.splitlines()
    assert [line.split()[0] for line in listed] == list(names())
    ran = crossview("gallery", "square", "-o", tmp_path)
    assert (ran.status, ran.err) == (0, "")
    assert [line.partition(":")[0] for line in ran.out.splitlines()][:2] == ["square", "square"]
    assert "1 of 1 as expected" in ran.out
    page = (tmp_path / "index.html").read_text(encoding="utf-8")
    for picture in ("figure", "quads"):
        assert pv.read(tmp_path / "square" / f"{picture}.png").dimensions[:2] == (1600, 1200)
        assert Pictured.load(tmp_path / "square" / f"{picture}.pdf").case.title
        assert f"square/{picture}.png" in page
    assert page.count("FAIL") == 0
    solved = find_case(str(tmp_path / "square" / "case.json"))
    assert solved.surface == find_case("square").surface
