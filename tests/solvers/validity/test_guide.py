"""Level lines of the holonomy potentials: closed forms, and defects of fields solved on them."""

from dataclasses import replace

import numpy as np
import pytest

from solvers.fields.isotropic import IsotropicSolver
from solvers.primitives import BUILTIN
from solvers.singularities.budget import Singularity
from solvers.surface.points import SurfacePoint
from solvers.surface.triangulation import QUARTER, wrap
from solvers.surface.trisurface import TriSurface
from solvers.validity.guide import Guide, LevelLines
from tests.solvers.suite import SURFACES, random_configuration


def along(lines: LevelLines, surface: TriSurface, count: int, exact: bool) -> list[SurfacePoint]:
    """Points of the lines, clear of the boundary: ends of pieces, or middles where those too
    are on the lines of the operator."""
    inner = ~surface.boundary_vertices[surface.faces[lines.faces]].any(axis=1)
    weights = lines.weights.mean(axis=1) if exact else lines.weights[:, 0]
    pieces = np.flatnonzero(inner)
    return [
        SurfacePoint(int(lines.faces[p]), tuple(weights[p]))
        for p in pieces[np.linspace(0, len(pieces) - 1, count).astype(int)]
    ]


@pytest.mark.parametrize(
    "name", ["annulus", "plate", "cylinder", "torus", "torus_with_hole", "double_torus", "slivers"]
)
@pytest.mark.parametrize("valence", [3, 6])
def test_fields_solved_on_the_lines_have_the_defect_they_say(name: str, valence: int) -> None:
    surface = SURFACES[name]()
    solver = IsotropicSolver(surface)
    singularities = random_configuration(surface, 3)
    # the budget stays met: what the first one takes the second one gives
    change = valence - singularities[0].valence
    singularities[0] = replace(singularities[0], valence=valence)
    singularities[1] = replace(singularities[1], valence=singularities[1].valence - change)
    exact = solver.discretization.working.n_flips == 0
    before = solver.holonomy.defects(singularities)
    guide = Guide(solver.holonomy, singularities, 0)
    for condition in range(len(before)):
        for lines, wanted in ((guide.closing(condition), 0.0), (guide.keeping(condition), before)):
            wanted = np.broadcast_to(wanted, before.shape)[condition]
            assert len(lines.faces) > 5
            for point in along(lines, surface, 6, exact):
                tried = [replace(singularities[0], point=point), *singularities[1:]]
                # next to a side a singularity is placed a little inside
                solved = solver.solve(tried).defects[condition]
                assert abs(np.degrees(wrap(solved - wanted, QUARTER))) < (
                    1e-6 if min(point.barycentric) > 1e-4 else 2e-5
                )


def test_the_lines_of_an_annulus_are_rays() -> None:
    """r = wrap(sum k phi / 4) by polar angles alone; a valence 6 has two rays that close it."""
    surface = BUILTIN["annulus"](inner=0.4, n=96)
    degrees = [13.0, 100.0, 190.0, 275.0]
    places = [0.7 * np.array([np.cos(a), np.sin(a), 0]) for a in np.radians(degrees)]
    for valences, rays in (([3, 5, 3, 5], 1), ([6, 3, 3, 4], 2)):
        singularities = [
            Singularity(surface.closest_point(x), v) for x, v in zip(places, valences, strict=True)
        ]
        holonomy = IsotropicSolver(surface).holonomy
        ends = Guide(holonomy, singularities, 0).closing(0).ends(surface).reshape(-1, 3)
        angles = np.degrees(np.arctan2(ends[:, 1], ends[:, 0]))
        others = np.array([4 - v for v in valences[1:]]) @ degrees[1:]
        period = 360 / abs(4 - valences[0])
        ray = -others / (4 - valences[0])
        off = (angles - ray + period / 2) % period - period / 2
        assert np.abs(off).max() < 0.05
        radius = np.linalg.norm(ends, axis=1)
        assert radius.min() == pytest.approx(0.4, abs=1e-3)
        assert radius.max() == pytest.approx(1.0, abs=1e-3)
        assert len(np.unique(np.round((angles - ray) / period).astype(int) % rays)) == rays


def test_lines_continue_over_the_jumps_of_the_potential() -> None:
    """Each end of a piece is the end of one more, or lies on the boundary."""
    for name in ("plate", "torus", "slivers"):
        surface = SURFACES[name]()
        holonomy = IsotropicSolver(surface).holonomy
        guide = Guide(holonomy, random_configuration(surface, 1), 0)
        ends = guide.closing(1 if name != "slivers" else 0).ends(surface).reshape(-1, 3)
        gaps = np.linalg.norm(ends[:, None] - ends[None], axis=2)
        np.fill_diagonal(gaps, np.inf)
        loose = ends[gaps.min(axis=1) > 1e-9 * surface.diagonal]
        rim = surface.vertices[surface.boundary_vertices]
        edge = surface.triangulation.lengths.max()
        to_rim = np.linalg.norm(loose[:, None] - rim, axis=2).min(axis=1, initial=np.inf)
        assert len(loose) % 2 == 0
        assert (to_rim < edge).all() if len(rim) else len(loose) == 0


@pytest.mark.parametrize("name", ["annulus", "plate", "torus", "slivers"])
def test_a_point_kept_on_a_line_closes_the_condition_and_stays_near(name: str) -> None:
    surface = SURFACES[name]()
    singularities = random_configuration(surface, 2)
    solver = IsotropicSolver(surface)
    guide = Guide(solver.holonomy, singularities, 0)
    for condition in range(len(solver.holonomy.conditions)):
        lines = guide.closing(condition)
        near = surface.position(along(lines, surface, 3, exact=True)[1])
        start = surface.closest_point(near + 0.3 * surface.triangulation.lengths.min())
        kept = guide.kept(condition, start)
        tried = [replace(singularities[0], point=kept), *singularities[1:]]
        assert abs(solver.holonomy.defects(tried)[condition]) < 1e-9
        way = np.linalg.norm(surface.position(kept) - surface.position(start))
        assert way < 2 * surface.triangulation.lengths.max()
