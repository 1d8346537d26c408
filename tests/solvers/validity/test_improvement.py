"""Singularities moved to where sizes are most even, every condition kept."""

from collections.abc import Iterable
from dataclasses import replace

import numpy as np
import numpy.typing as npt
import pytest
from scipy.spatial.transform import Rotation

from solvers.errors import CrossviewError, SingularityError
from solvers.features.edges import Features
from solvers.fields.isotropic import IsotropicSolver
from solvers.primitives import BUILTIN
from solvers.progress import Progress, run
from solvers.singularities.budget import Singularity
from solvers.singularities.spacing import CLOSEST
from solvers.surface import TriSurface, straightest
from solvers.validity import Improved, Unevenness, improve, make_valid, missing_singularities

CUBE = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) / np.sqrt(3)


def threes(surface: TriSurface, places: Iterable[npt.ArrayLike]) -> list[Singularity]:
    return [Singularity(surface.closest_point(place), 3) for place in places]


def plate() -> tuple[TriSurface, tuple[Singularity, ...]]:
    surface = BUILTIN["plate_with_holes"](holes=2, edge_length=0.12)
    found = run(missing_singularities(IsotropicSolver(surface), ()))
    return surface, run(make_valid(surface, found)).singularities


@pytest.mark.parametrize("wanted", [False, True])
def test_the_slope_is_that_of_the_variance(wanted: bool) -> None:
    surface = BUILTIN["sphere"](subdivisions=3)
    sizes = np.exp(0.3 * surface.vertices[:, 2]) if wanted else None
    unevenness = Unevenness(IsotropicSolver(surface), sizes)
    chance = np.random.default_rng(1)
    placed = threes(surface, CUBE + 0.1 * chance.normal(size=CUBE.shape))
    slope = unevenness.gradient(unevenness.sizes(placed))
    step = 1e-6 * surface.triangulation.lengths.mean()
    for j in (0, 5):
        for axis in np.eye(2):
            ends = [
                replace(placed[j], point=straightest(surface, placed[j].point, d).end)
                for d in (step * axis, -step * axis)
            ]
            rise = [unevenness.sizes([*placed[:j], end, *placed[j + 1 :]]).variance for end in ends]
            assert (rise[0] - rise[1]) / (2 * step) == pytest.approx(slope[j] @ axis, rel=1e-4)


def test_the_variance_tends_to_one_value_wherever_the_triangles_are() -> None:
    spread = []
    for subdivisions in (2, 3, 4):
        surface = BUILTIN["sphere"](subdivisions=subdivisions)
        unevenness = Unevenness(IsotropicSolver(surface))
        turned = [Rotation.random(random_state=i).apply(CUBE) for i in range(8)]
        found = [unevenness.sizes(threes(surface, x)).variance for x in turned]
        spread.append(np.std(found) / np.mean(found))
    assert spread[0] > 2 * spread[1] > 4 * spread[2]


def test_four_on_a_disk_end_at_the_corners_of_a_square() -> None:
    surface = BUILTIN["disk"](edge_length=0.05)
    start = threes(surface, [[0.3, 0.1, 0], [0, 0.4, 0], [-0.5, 0, 0], [0, -0.2, 0]])
    end = run(improve(surface, start))
    x, y, _ = surface.positions([s.point for s in end.singularities]).T
    assert np.ptp(np.hypot(x, y)) < 0.01
    between = np.diff(np.sort(np.degrees(np.arctan2(y, x))))
    assert np.abs(between - 90).max() < 1
    # one other radius, turned as the disk's rim has it: all less even
    unevenness = Unevenness(IsotropicSolver(surface))
    for factor in (0.95, 1.05):
        others = np.stack([factor * x, factor * y, 0 * x], axis=1)
        assert unevenness.sizes(threes(surface, others.tolist())).variance > end.sizes.variance


def test_every_step_keeps_every_defect_at_zero_and_is_more_even() -> None:
    surface, start = plate()
    seen: list[Progress] = []
    end = run(improve(surface, start), seen.append)
    way = [step for step in seen if isinstance(step, Improved)]
    assert len(way) > 3
    # the start's vanish on the refined surface, the others' on the surface's own triangulation
    assert max(np.abs(step.defects).max() for step in way[1:]) < np.radians(1e-6)
    assert (np.diff([step.sizes.variance for step in way]) < 0).all()
    assert np.abs(end.defects).max() < np.radians(1e-6)
    assert end.sizes.variance < 0.5 * end.before.variance
    assert end.sizes.ratio < end.before.ratio


def test_what_is_not_valid_is_made_valid_first() -> None:
    surface, start = plate()
    astray = straightest(surface, start[0].point, [0.05, 0.03]).end
    moved = (replace(start[0], point=astray), *start[1:])
    holonomy = IsotropicSolver(surface).holonomy
    assert np.abs(holonomy.defects(moved)).max() > np.radians(0.1)
    end = run(improve(surface, moved))
    assert np.abs(end.defects).max() < np.radians(1e-6)
    assert end.start != moved


def test_turning_scaling_and_renumbering_change_nothing() -> None:
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
    ends = run(improve(surface, start)), run(improve(other, there))
    one, two = (e.sizes.variance for e in ends)
    assert one == pytest.approx(two, rel=1e-3)
    places = surface.positions([s.point for s in ends[0].singularities])
    moved = other.positions([s.point for s in ends[1].singularities])
    assert np.abs(7 * turn.apply(places) - moved).max() < 0.05 * 7


def test_what_is_locked_never_moves() -> None:
    surface, start = plate()
    held = [replace(s, locked=i % 2 == 0) for i, s in enumerate(start)]
    seen: list[Progress] = []
    end = run(improve(surface, held), seen.append)
    for step in seen:
        if isinstance(step, Improved):
            assert all(a == b for a, b in zip(step.singularities, held, strict=True) if b.locked)
    assert end.sizes.variance < end.before.variance


def test_where_nothing_may_move_it_is_said() -> None:
    surface, start = plate()
    locked = [replace(s, locked=True) for s in start]
    with pytest.raises(SingularityError, match="no singularity may move: unlock some"):
        run(improve(surface, locked))
    with pytest.raises(SingularityError, match="index budget"):
        run(improve(surface, start[:-1]))


def test_with_a_size_map_sizes_come_nearer_to_it() -> None:
    surface = BUILTIN["disk"](edge_length=0.08)
    start = threes(surface, [[0.5, 0.5, 0], [-0.5, 0.5, 0], [-0.5, -0.5, 0], [0.5, -0.5, 0]])
    sizes = np.exp(0.8 * surface.vertices[:, 0])
    even, graded = (run(improve(surface, start, wanted=w)) for w in (None, sizes))
    unevenness = Unevenness(IsotropicSolver(surface), sizes)
    assert graded.sizes.variance < 0.9 * unevenness.sizes(even.singularities).variance
    with pytest.raises(CrossviewError, match="the size map has 3 numbers"):
        run(improve(surface, start, wanted=np.ones(3)))


def test_a_symmetric_optimum_is_left_as_it_is() -> None:
    surface = BUILTIN["sphere"](subdivisions=3)
    end = run(
        improve(surface, [replace(s, locked=i > 0) for i, s in enumerate(threes(surface, CUBE))])
    )
    gap = surface.position(end.singularities[0].point) - CUBE[0]
    # the seven others hold the eighth at the cube's corner, to the size of a triangle
    assert np.linalg.norm(gap) < surface.triangulation.lengths.mean()


def anticube(surface: TriSurface) -> float:
    """The least variance of two squares facing each other, one turned by 45 degrees."""
    unevenness = Unevenness(IsotropicSolver(surface))
    turn = np.pi / 4 * np.arange(8)
    found = []
    for height in np.linspace(0.5, 0.65, 16):
        radius = np.sqrt(1 - height**2)
        side = height * (-1.0) ** np.arange(8)
        places = np.stack([radius * np.cos(turn), radius * np.sin(turn), side], axis=1)
        found.append(unevenness.sizes(threes(surface, places)).variance)
    return min(found)


@pytest.mark.parametrize("near_the_cube", [False, True])
def test_eight_on_a_sphere_come_to_the_anticube(near_the_cube: bool) -> None:
    surface = BUILTIN["sphere"](subdivisions=4)
    chance = np.random.default_rng(1)
    start = chance.normal(size=(8, 3)) + (8 * CUBE if near_the_cube else 0)
    end = run(improve(surface, threes(surface, start)))
    least = anticube(surface)
    cube = Unevenness(IsotropicSolver(surface)).sizes(threes(surface, CUBE)).variance
    assert end.sizes.variance < least + 0.25 * (cube - least)


def walled() -> tuple[TriSurface, Features]:
    surface = BUILTIN["square"](n=20)
    x = surface.vertices[surface.edges, 0]
    return surface, Features(surface, np.flatnonzero((np.abs(x) < 1e-9).all(axis=1)))


def test_none_crosses_a_feature_nor_comes_near_to_it() -> None:
    surface, wall = walled()
    pair = [
        Singularity(surface.closest_point([x, y, 0]), valence)
        for x, y, valence in ((-0.2, 0, 3), (0.1, 0.1, 5))
    ]
    seen: list[Progress] = []
    end = run(improve(surface, pair, features=wall), seen.append)
    assert end.sizes.variance < 0.5 * end.before.variance
    for step in seen:
        if isinstance(step, Improved):
            three, five = surface.positions([s.point for s in step.singularities])[:, 0]
            assert three < -0.99 * CLOSEST
            assert five > 0.99 * CLOSEST


def test_what_is_on_a_feature_stays_there() -> None:
    surface, wall = walled()
    three = Singularity(surface.closest_point([0, 0.1, 0]), 3)
    five = Singularity(surface.closest_point([0.3, 0.1, 0]), 5)
    end = run(improve(surface, [three, five], features=wall))
    assert end.singularities[0] == three
    assert end.singularities[1] != five
    with pytest.raises(SingularityError, match="may move: move some off the features"):
        run(improve(surface, [three, replace(five, locked=True)], features=wall))
