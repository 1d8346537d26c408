"""Tools that keep the index sum: known answers, and refusals with their reason."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from solvers.errors import SingularityError
from solvers.primitives import BUILTIN
from solvers.singularities.budget import Singularity
from solvers.singularities.pairs import merged, pair_at, split
from solvers.singularities.symmetry import mirrored, rotated
from solvers.surface.trisurface import TriSurface
from tests.solvers.suite import SURFACES

SQUARE = BUILTIN["square"](n=40)


def at(surface: TriSurface, *placed: tuple[list[float], int]) -> list[Singularity]:
    return [Singularity(surface.closest_point(x), v) for x, v in placed]


def where(surface: TriSurface, singularities: Sequence[Singularity]) -> np.ndarray:
    return surface.positions([s.point for s in singularities])


def sum_of(singularities: Sequence[Singularity]) -> int:
    return sum(s.index for s in singularities)


@pytest.mark.parametrize("name", [name for name in SURFACES if name != "slivers"])  # bent
def test_a_pair_keeps_the_sum_and_lies_about_its_place(name: str) -> None:
    surface = SURFACES[name]()
    inner = np.flatnonzero(~surface.boundary_vertices)
    rim = surface.vertices[surface.boundary_vertices]
    away = np.linalg.norm(surface.vertices[inner][:, None] - rim, axis=2).min(1, initial=9)
    place = surface.point_at_vertex(int(inner[np.argmax(away)]))
    pair = pair_at(surface, [], place, apart=0.02 * surface.diagonal)
    assert [s.valence for s in pair] == [3, 5]
    ends = where(surface, pair)
    assert np.linalg.norm(ends[1] - ends[0]) == pytest.approx(0.02 * surface.diagonal, rel=0.05)
    assert np.linalg.norm(ends.mean(axis=0) - surface.position(place)) < 0.003 * surface.diagonal


def test_a_pair_turns_away_from_what_is_near() -> None:
    others = at(SQUARE, ([-0.05, 0, 0], 3), ([0.05, 0, 0], 5))
    ends = where(SQUARE, pair_at(SQUARE, others, SQUARE.closest_point([0, 0, 0]), apart=0.06))
    assert np.abs(ends[:, 0]).max() < 1e-9
    assert np.abs(ends[:, 1]).min() == pytest.approx(0.03)


def test_a_pair_without_room_is_refused() -> None:
    with pytest.raises(SingularityError, match=r"no room.*farther from the others"):
        pair_at(SQUARE, [], SQUARE.closest_point([0.5, 0.5, 0]))


@pytest.mark.parametrize(
    ("two", "one"),
    [((3, 3), 2), ((5, 5), 6), ((6, 6), 8), ((3, 6), 5), ((2, 3), 1), ((3, 5), None)],
)
def test_two_merge_into_one_of_the_same_sum_midway(two: tuple[int, int], one: int | None) -> None:
    start = at(SQUARE, ([-0.2, 0.1, 0], two[0]), ([0.3, 0.3, 0], 8), ([0.2, 0.1, 0], two[1]))
    end = merged(SQUARE, start, 2, 0)
    assert sum_of(end) == sum_of(start)
    assert [s.valence for s in end] == ([8] if one is None else [one, 8])
    if one is not None:
        np.testing.assert_allclose(where(SQUARE, end)[0], [0, 0.1, 0], atol=1e-12)


def test_a_locked_one_keeps_its_place_when_merged() -> None:
    start = at(SQUARE, ([-0.2, 0.1, 0], 5), ([0.2, 0.1, 0], 5))
    start[1] = replace(start[1], locked=True)
    (end,) = merged(SQUARE, start, 0, 1)
    assert end == replace(start[1], valence=6)
    with pytest.raises(SingularityError, match=r"locked.*#1 and #2.*unlock one"):
        merged(SQUARE, [replace(s, locked=True) for s in start], 0, 1)


def test_what_has_no_valence_does_not_merge() -> None:
    with pytest.raises(SingularityError, match=r"no valence has the index 4"):
        merged(SQUARE, at(SQUARE, ([0, 0, 0], 1), ([0.2, 0, 0], 3)), 0, 1)
    with pytest.raises(SingularityError, match=r"takes two"):
        merged(SQUARE, at(SQUARE, ([0, 0, 0], 5)), 0, 0)


@pytest.mark.parametrize(
    ("one", "two"), [(6, [5, 5]), (8, [6, 6]), (2, [3, 3]), (7, [6, 5]), (1, [2, 3])]
)
def test_one_splits_into_two_halves_about_its_place(one: int, two: list[int]) -> None:
    start = at(SQUARE, ([0.3, 0.3, 0], 3), ([-0.1, 0, 0], one), ([0.3, -0.3, 0], 5))
    end = split(SQUARE, start, 1)
    assert [s.valence for s in end] == [3, *two, 5]
    assert sum_of(end) == sum_of(start)
    np.testing.assert_allclose(where(SQUARE, end[1:3]).mean(axis=0), [-0.1, 0, 0], atol=1e-9)
    again = merged(SQUARE, end, 1, 2)
    np.testing.assert_allclose(where(SQUARE, again), where(SQUARE, start), atol=1e-9)
    assert [s.valence for s in again] == [s.valence for s in start]


def test_what_cannot_be_split_is_refused() -> None:
    for valence in (3, 5):
        with pytest.raises(SingularityError, match=r"cannot be split.*add a pair"):
            split(SQUARE, at(SQUARE, ([0, 0, 0], valence)), 0)
    (locked,) = at(SQUARE, ([0, 0, 0], 6))
    with pytest.raises(SingularityError, match=r"locked.*unlock"):
        split(SQUARE, [replace(locked, locked=True)], 0)


def test_mirror_images_and_turns_on_a_square() -> None:
    start = at(SQUARE, ([0.1, 0.2, 0], 3), ([-0.3, 0.05, 0], 5))
    x = where(SQUARE, start)
    np.testing.assert_allclose(where(SQUARE, mirrored(SQUARE, start, 0)), x * [-1, 1, 1], atol=1e-9)
    quarter = rotated(SQUARE, start, 2, np.pi / 2)
    np.testing.assert_allclose(where(SQUARE, quarter), x[:, [1, 0, 2]] * [-1, 1, 1], atol=1e-9)
    assert [s.valence for s in quarter] == [3, 5]
    full: Sequence[Singularity] = start
    for _ in range(4):
        full = rotated(SQUARE, full, 2, np.pi / 2)
    np.testing.assert_allclose(where(SQUARE, full), x, atol=1e-9)


def test_a_body_that_lies_askew_is_mirrored_about_its_own_axes() -> None:
    straight = BUILTIN["ellipsoid"](subdivisions=3)
    angle = 0.4
    turn = np.array(
        [[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]]
    )
    askew = TriSurface(straight.vertices @ turn.T + [3, 1, 0], straight.faces)
    x = straight.vertices[[17]]
    (end,) = mirrored(askew, at(askew, ((x @ turn.T + [3, 1, 0])[0], 3)), 0)
    expected = (x * [-1, 1, 1]) @ turn.T + [3, 1, 0]
    assert np.linalg.norm(askew.position(end.point) - expected) < 0.02 * askew.diagonal


def test_a_surface_that_is_not_symmetrical_and_a_lock_are_refused() -> None:
    shape = SURFACES["l_shape"]()
    corner = shape.vertices[np.argmax(shape.vertices @ [1, -0.5, 0])]
    inside = shape.closest_point(0.9 * corner + 0.1 * shape.vertices.mean(axis=0))
    with pytest.raises(SingularityError, match=r"not symmetrical enough.*away from it"):
        rotated(shape, [Singularity(inside, 3)], 2, np.pi / 3)
    locked = [replace(s, locked=True) for s in at(SQUARE, ([0.1, 0.2, 0], 3))]
    with pytest.raises(SingularityError, match=r"#1 is locked"):
        mirrored(SQUARE, locked, 0)
    on_plane = [replace(s, locked=True) for s in at(SQUARE, ([0.0, 0.2, 0], 3))]
    assert mirrored(SQUARE, on_plane, 0) == tuple(on_plane)
