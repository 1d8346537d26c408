"""Separatrices made to meet what they nearly meet, and how their misses change with moves."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from solvers.errors import SingularityError
from solvers.fields.aligned import IntegratedField, aligned_field
from solvers.fields.isotropic import IsotropicSolver
from solvers.fields.prepared import prepare
from solvers.layouts import Snapped, holding, join, nearly_connected, quad_layout, snap
from solvers.layouts.near_misses import Passings, SeparatrixWays
from solvers.primitives import BUILTIN
from solvers.progress import Progress, run
from solvers.singularities.budget import Singularity
from solvers.surface import FloatArray, TriSurface, straightest
from solvers.validity import improve, make_valid, missing_singularities

Places = tuple[Singularity, ...]


@cache
def plate() -> tuple[TriSurface, Places]:
    """A plate with a hole and one of its four singularities off its place."""
    surface = BUILTIN["plate_with_holes"](holes=1, edge_length=0.12)
    found = run(missing_singularities(IsotropicSolver(surface), ()))
    first, *others = run(make_valid(surface, found)).singularities
    off = replace(first, point=straightest(surface, first.point, [-0.05, 0.1]).end)
    return surface, run(make_valid(surface, [off, *others])).singularities


def patches(surface: TriSurface, singularities: Places) -> int:
    aligned = aligned_field(prepare(surface, singularities))
    return run(quad_layout(IntegratedField(aligned, aligned.start))).patches


def ways(surface: TriSurface, singularities: Places) -> SeparatrixWays:
    return SeparatrixWays(prepare(surface, singularities))


def found_again(wanted: Passings, there: Passings) -> FloatArray:
    """The offsets of what is nearest to each of some passings."""
    offsets = []
    for nodes, length, offset in zip(wanted.nodes, wanted.length, wanted.offset, strict=True):
        same = np.flatnonzero((there.nodes == nodes).all(axis=1))
        off = np.hypot(there.length[same] - length, there.offset[same] - offset)
        offsets.append(there.offset[same[np.argmin(off)]])
    return np.array(offsets)


def test_misses_change_as_differences_say() -> None:
    surface, start = plate()
    here = ways(surface, start)
    passings = here.passings[here.passings.angles < np.radians(6)]
    passings = passings[np.argsort(passings.length)[:8]]
    axes = np.stack(surface.face_frames, axis=1)[[s.point.face for s in start]]
    slopes = here.gradients(passings, axes)
    step = 1e-2
    for j in range(len(start)):
        for axis in range(2):
            ends = []
            for d in (step * np.eye(2)[axis], -step * np.eye(2)[axis]):
                moved = replace(start[j], point=straightest(surface, start[j].point, d).end)
                there = ways(surface, (*start[:j], moved, *start[j + 1 :])).passings
                ends.append(found_again(passings, there))
            by_differences = (ends[0] - ends[1]) / (2 * step)
            own = (passings.nodes == j).any(axis=1)
            off = np.abs(slopes[:, j, axis] - by_differences)
            assert (off[~own] < 0.03 * (1 + np.abs(by_differences[~own]))).all()
            # where the end itself moves the triangles around it are told of as one
            assert (off[own] < 0.12).all()


def test_snapped_singularities_are_joined_and_the_layout_is_coarser() -> None:
    surface, start = plate()
    seen: list[Progress] = []
    end = run(snap(surface, start), seen.append)
    way = [step for step in seen if isinstance(step, Snapped)]
    assert way[0].misses.max() > np.radians(1)
    assert end.misses.max() < np.radians(0.5)
    assert np.abs(end.defects).max() < np.radians(1e-6)
    assert patches(surface, start) > 12 == patches(surface, end.singularities)


def test_what_is_snapped_stays() -> None:
    surface, start = plate()
    once = run(snap(surface, start))
    twice = run(snap(surface, once.singularities))
    places = [surface.positions([s.point for s in e.singularities]) for e in (once, twice)]
    assert np.linalg.norm(places[1] - places[0], axis=1).max() < 0.01


def test_what_is_locked_never_moves() -> None:
    surface, start = plate()
    held = (start[0], *(replace(s, locked=True) for s in start[1:]))
    end = run(snap(surface, held))
    assert end.singularities[1:] == held[1:]
    assert len(end.connections) <= 1  # two freedoms, one of them for the hole's condition


def test_turning_and_renumbering_change_nothing() -> None:
    surface, start = plate()
    turn = Rotation.from_rotvec([0.3, 1.2, -0.4])
    order = np.random.default_rng(0).permutation(surface.n_faces)
    other = TriSurface(7 * turn.apply(surface.vertices.copy()), surface.faces[order])
    there = [
        replace(
            s, point=other.point(int(np.flatnonzero(order == s.point.face)[0]), s.point.barycentric)
        )
        for s in start
    ]
    one, two = run(snap(surface, start)), run(snap(other, there))
    assert len(one.connections) == len(two.connections)
    places = surface.positions([s.point for s in one.singularities])
    moved = other.positions([s.point for s in two.singularities])
    assert np.abs(7 * turn.apply(places) - moved).max() < 0.01 * 7


def test_where_nothing_can_be_snapped_it_is_said() -> None:
    surface, start = plate()
    with pytest.raises(SingularityError, match="no singularity may move: unlock some"):
        run(snap(surface, [replace(s, locked=True) for s in start]))
    with pytest.raises(SingularityError, match="index budget"):
        run(snap(surface, start[1:]))
    disk = BUILTIN["disk"](edge_length=0.1)
    lone = Singularity(disk.closest_point([0.1, 0, 0]), 6)
    corners = {int(v): 1 for v in disk.boundary_loops[0][::4][:6]}
    with pytest.raises(SingularityError, match="no separatrix can be made to meet"):
        run(snap(disk, [lone], corners))


def test_joined_singularities_stay_so_while_they_are_improved() -> None:
    surface, start = plate()
    joined = run(snap(surface, start))
    pairs = tuple((a, b) for a, b in joined.connections.tolist())
    off = replace(start[0], point=straightest(surface, start[0].point, [0.02, 0.02]).end)
    moved = (off, *joined.singularities[1:])
    again = run(join(surface, moved, pairs))
    assert sorted(again.connections.tolist()) == sorted(joined.connections.tolist())
    assert patches(surface, again.singularities) == 12
    free, held = (
        run(improve(surface, moved)),
        run(improve(surface, again.singularities, hold=holding(pairs))),
    )
    assert held.sizes.variance <= held.before.variance
    there = run(join(surface, held.singularities, pairs)).singularities
    places = [
        surface.positions([s.point for s in placed]) for placed in (there, held.singularities)
    ]
    assert np.linalg.norm(places[1] - places[0], axis=1).max() < 0.01
    assert free.singularities != held.singularities
    assert patches(surface, held.singularities) == 12


def test_pairs_that_no_separatrix_nearly_joins_are_refused() -> None:
    surface, start = plate()
    with pytest.raises(SingularityError, match="singularities 1 and 3 cannot be kept joined"):
        run(join(surface, start, ((0, 2), (0, 2), (0, 2))))
    with pytest.raises(SingularityError, match="whole numbers from 0 to 3, not 4"):
        run(join(surface, start, ((0, 4),)))


def test_what_snap_says_is_joined_is_found_again_and_leaves_no_near_miss() -> None:
    surface = BUILTIN["plate_with_holes"](holes=3, edge_length=0.15)
    found = run(missing_singularities(IsotropicSolver(surface), ()))
    start = run(make_valid(surface, found)).singularities
    end = run(snap(surface, start))
    assert len(nearly := run(nearly_connected(surface, start)).pairs) > 5
    pairs = tuple((a, b) for a, b in end.connections.tolist())
    left = run(nearly_connected(surface, end.singularities, kept=pairs))
    assert len(left) < len(nearly) / 2
    again = run(join(surface, end.singularities, pairs))
    assert again.misses.max() < np.radians(0.5)
