"""The verdict and the refusal of quads agree, whatever the case's tolerance."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from crossview.cases.model import Builtin, Case, Options, PlacedSingularity
from crossview.workflow.layout import layout, misaligned_boundaries
from crossview.workflow.pipeline import Pipeline, Solution
from crossview.workflow.problem import Problem
from solvers.layouts.errors import LayoutError
from solvers.progress import run


@cache
def problem(off: float) -> Problem:
    """Four valence 3, four valence 5 each `off` degrees further: about that defect."""
    singularities = []
    for radius, turn, valence in ((0.8, 0.0, 3), (0.6, off, 5)):
        for angle in np.radians(90 * np.arange(4) + turn):
            place = (radius * float(np.cos(angle)), radius * float(np.sin(angle)), 0.0)
            singularities.append(PlacedSingularity(place, valence))
    return Problem.from_case(Case(Builtin("annulus", {"n": 48}), tuple(singularities)))


def solved(off: float, method: str, tolerance: float) -> Solution:
    options = Options(tolerance_degrees=tolerance)
    return run(Pipeline().solve(replace(problem(off), method=method, options=options)))


def refusal(solution: Solution) -> LayoutError | None:
    try:
        run(layout(solution))
    except LayoutError as error:
        return error
    return None


@pytest.mark.parametrize("off", [0.02, 0.1, 1.0, 3.0])
@pytest.mark.parametrize("method", ["isotropic", "aligned"])
def test_a_defect_just_below_the_tolerance_is_valid_and_has_quads_one_above_has_neither(
    off: float, method: str
) -> None:
    (defect,) = np.degrees(np.abs(solved(off, method, 0.01).holonomy_defects))
    below = solved(off, method, 1.02 * defect)
    assert below.valid
    assert below.verdict.status == "valid"
    assert refusal(below) is None
    assert not len(misaligned_boundaries(below)[0])
    above = solved(off, method, 0.98 * defect)
    assert not above.valid
    assert above.verdict.status != "valid"
    refused = refusal(above)
    if method == "isotropic":
        assert refused is not None
        assert "misses a boundary" in refused.what
        assert len(misaligned_boundaries(above)[0]) == 1
    assert (refused is not None) == above.verdict.refused


@pytest.mark.parametrize("tolerance", [0.01, 0.1, 1.0])
@pytest.mark.parametrize("off", [0.005, 0.02, 0.5, 2.0])
def test_a_verdict_of_valid_is_never_refused(off: float, tolerance: float) -> None:
    for method in ("isotropic", "aligned", "anisotropic"):
        solution = solved(off, method, tolerance)
        assert (refusal(solution) is not None) == solution.verdict.refused
        assert not (solution.verdict.refused and solution.verdict.status == "valid")
    assert solution.verdict.status == "valid"
