"""Features that no injective map can follow: some are released, the others are followed."""

from __future__ import annotations

import numpy as np

from crossview.export.report import report, summary
from crossview.workflow.marking import Marking
from crossview.workflow.pipeline import Pipeline
from crossview.workflow.problem import Problem
from crossview.workflow.solution import NO_MAP
from solvers.primitives import BUILTIN
from solvers.progress import Progress, run
from solvers.singularities.budget import Singularity
from solvers.surface.edge_paths import EdgePaths
from solvers.surface.trisurface import TriSurface

N, RINGS = 24, 6
"""Vertices of each circle of the annulus; circles between its boundaries and with them, less one.
"""


def annulus() -> TriSurface:
    """A polar grid."""
    turn = 2 * np.pi * np.arange(N) / N
    radius = np.exp(2 * np.pi * np.arange(RINGS + 1) / N)[:, None]
    x, y = radius * np.cos(turn), radius * np.sin(turn)
    i, j = np.divmod(np.arange(RINGS * N), N)
    a, b = i * N + j, i * N + (j + 1) % N
    faces = np.concatenate([np.stack([a, a + N, b + N], axis=1), np.stack([a, b + N, b], axis=1)])
    return TriSurface(np.stack([x, y, 0 * x], axis=2).reshape(-1, 3), faces)


def along(surface: TriSurface, *vertices: tuple[int, int]) -> frozenset[int]:
    """The edges of a path through vertices (circle, how far around)."""
    path = np.array([ring * N + around % N for ring, around in vertices])
    return frozenset(EdgePaths(surface).through(path).tolist())


def spoke(surface: TriSurface) -> frozenset[int]:
    return along(surface, *((ring, 0) for ring in range(RINGS + 1)))


def once_around(surface: TriSurface, rise: int) -> frozenset[int]:
    """From the spoke at circle 2 around the annulus to the spoke at a higher circle."""
    flat = [(2, k) for k in range(N // 2)]
    return along(surface, *flat, *((2 + rise, k) for k in range(N // 2 + rise - 1, N + 1)))


def test_a_curve_that_comes_back_elsewhere_than_it_left_is_released() -> None:
    """Left of the spoke and right of it a piece would have sides of one length, and of another.

    Cut along the spoke the annulus is a rectangle, and the curve cuts that into two: opposite sides
    of each are equally long in a map, but one is a part of the other on the spoke.
    """
    surface = annulus()
    marked = spoke(surface) | once_around(surface, rise=2)
    problem = Problem(surface, method="anisotropic", marking=Marking(marked=marked))
    steps: list[Progress] = []
    solution = run(Pipeline().solve(problem), steps.append)
    assert solution.verdict.status == "valid"
    assert len(solution.released) > 0
    assert len(solution.features) > 0
    assert len(solution.features) + len(solution.released) == len(marked)
    assert np.abs(solution.field.feature_misalignment).max() < 1e-9
    found = report(solution)["released_features"]
    assert {curve["reason"] for curve in found} == {NO_MAP}
    assert f"{NO_MAP} ({len(found)})" in summary(solution)
    fractions = [step.fraction for step in steps]
    assert fractions == sorted(fractions)
    assert any("without" in step.stage for step in steps)


def test_where_all_curves_have_a_map_none_is_released() -> None:
    surface = annulus()
    marked = spoke(surface) | once_around(surface, rise=0)
    problem = Problem(surface, method="anisotropic", marking=Marking(marked=marked))
    steps: list[Progress] = []
    solution = run(Pipeline().solve(problem), steps.append)
    assert solution.verdict.status == "valid"
    assert solution.released_for == {}
    assert len(solution.features) == len(marked)
    assert not any("without" in step.stage for step in steps)


def test_what_a_theorem_forbids_is_not_tried_with_fewer_features() -> None:
    """A valence 3 and a valence 5 alone on a torus, whatever is followed."""
    surface = BUILTIN["torus"](n=16)
    pair = [Singularity(surface.closest_point([x, 0.0, 0.0]), k) for x, k in ((1.4, 3), (-0.6, 5))]
    marked = frozenset(EdgePaths(surface).through(np.array([0, 1, 2])).tolist())
    problem = Problem(surface, pair, method="anisotropic", marking=Marking(marked=marked))
    steps: list[Progress] = []
    solution = run(Pipeline().solve(problem), steps.append)
    assert solution.verdict.status == "impossible"
    assert solution.released_for == {}
    assert not any("without" in step.stage for step in steps)
