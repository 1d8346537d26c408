"""Numbers from outside: what is one goes in unchanged, what is none is refused in one line."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from solvers.errors import CrossviewError
from solvers.features.dihedral import sharp_edges
from solvers.fields.alternating import alternate
from solvers.fields.isotropic import IsotropicSolver
from solvers.fields.natural import natural_singularities
from solvers.number_checks import (
    EXACT,
    LARGEST,
    real_number,
    real_numbers,
    whole_number,
    whole_numbers,
)
from solvers.primitives import BUILTIN
from solvers.progress import run
from solvers.repair.soup import repair
from solvers.singularities.budget import Singularity
from solvers.singularities.pairs import merged, pair_at, split
from solvers.singularities.symmetry import mirrored, rotated
from solvers.surface.points import SurfacePoint
from solvers.surface.refinement import refine_at
from solvers.surface.trisurface import TriSurface

SQUARE = BUILTIN["square"](n=4)
MIDDLE = SQUARE.closest_point([0.0, 0.0, 0.0])
CORNERS = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]

NO_NUMBERS: list[Any] = [True, np.True_, None, "3", 3j, [3], np.nan, np.inf, 10**400]
"""What is no number anywhere."""


@given(st.integers(-EXACT, EXACT))
def test_every_way_to_write_a_whole_number_is_the_same(n: int) -> None:
    written = [n, np.int64(n), float(n), np.float64(n)]
    for value in written:
        found = whole_number("n", value)
        assert found == n
        assert type(found) is int
        assert whole_numbers("n", np.array([value, value])).tolist() == [n, n]


@given(st.floats(-1e15, 1e15).filter(lambda x: x != int(x)))
def test_no_fraction_is_cut(x: float) -> None:
    for wrong in (x, np.float64(x)):
        with pytest.raises(CrossviewError, match="n must be a whole number"):
            whole_number("n", wrong)
    with pytest.raises(CrossviewError, match=r"n must be whole numbers.*row 1"):
        whole_numbers("n", np.array([[0, 1], [2, x]]))
    assert real_number("x", x) == x


@given(st.integers(-50, 50), st.integers(-50, 50), st.integers(-50, 50))
def test_bounds_are_kept_and_named(n: int, one: int, other: int) -> None:
    least, most = sorted((one, other))
    if least <= n <= most:
        assert whole_number("n", n, least, most) == real_number("n", n, least, most) == n
    else:
        for check in (whole_number, real_number):
            with pytest.raises(CrossviewError, match=f"from {least} to {most}, not {n}"):
                check("n", n, least, most)


@pytest.mark.parametrize("wrong", NO_NUMBERS, ids=lambda value: repr(value)[:12])
def test_what_is_no_number_is_none_anywhere(wrong: Any) -> None:
    for check in (whole_number, real_number):
        with pytest.raises(CrossviewError, match="n must be a") as refused:
            check("n", wrong)
        assert len(str(refused.value)) < 120
        assert "\n" not in str(refused.value)


def test_numbers_too_large_to_compute_with_are_refused() -> None:
    assert real_number("x", 0.99 * LARGEST) == 0.99 * LARGEST
    for value in (LARGEST, -LARGEST):
        with pytest.raises(CrossviewError):
            real_number("x", value)
    with pytest.raises(CrossviewError):
        whole_number("n", 2.0 * EXACT)


def test_shapes_are_named() -> None:
    with pytest.raises(CrossviewError, match="p must be 3 numbers, not 2 x 2"):
        real_numbers("p", [[0, 1], [2, 3]], (3,))
    with pytest.raises(CrossviewError, match="p must be any number x 3 numbers, not a single one"):
        real_numbers("p", 1.0, (None, 3))
    with pytest.raises(CrossviewError, match="in rows of one length"):
        real_numbers("p", [[0, 1], [2]])


def test_what_is_checked_is_a_copy() -> None:
    given_, whole = np.zeros(3), np.zeros(3, dtype=np.int64)
    real_numbers("x", given_)[0] = whole_numbers("n", whole)[0] = 1
    assert not given_.any()
    assert not whole.any()


def corners_of(vertex: Any, index: Any) -> Callable[[], object]:
    return lambda: IsotropicSolver(SQUARE, {vertex: index})


REFUSED: dict[str, Callable[[], object]] = {
    "half a quad at a singularity": lambda: Singularity(MIDDLE, 3.5),  # type: ignore[arg-type]
    "no quad at a singularity": lambda: Singularity(MIDDLE, 0),
    "a true valence": lambda: Singularity(MIDDLE, True),
    "half a vertex": lambda: TriSurface(CORNERS, [[0, 1, 2.7]]),
    "half a vertex to repair": lambda: repair(CORNERS, [[0, 1, 2.7]]),
    "true corners": lambda: TriSurface(CORNERS, [[False, True, True]]),
    "no corner at all": lambda: TriSurface(CORNERS, [[0, 1, np.nan]]),
    "coordinates in words": lambda: TriSurface([["0", "0", "0"]] * 3, [[0, 1, 2]]),
    "rows of two lengths": lambda: TriSurface([[0, 0, 0], [1, 0], [0, 1, 0]], [[0, 1, 2]]),
    "half a face": lambda: SurfacePoint(0.5, (1.0, 0.0, 0.0)),  # type: ignore[arg-type]
    "a face before the first": lambda: SurfacePoint(-1, (1.0, 0.0, 0.0)),
    "weights of two corners": lambda: SurfacePoint(0, (0.5, 0.5)),  # type: ignore[arg-type]
    "weights that sum to 2": lambda: SurfacePoint(0, (1.0, 0.5, 0.5)),
    "a negative weight": lambda: SurfacePoint(0, (1.5, -0.5, 0.0)),
    "a weight that is none": lambda: SurfacePoint(0, (np.nan, 0.5, 0.5)),
    "a vertex that is none": lambda: SQUARE.point_at_vertex(-1),
    "a vertex beyond the last": lambda: SQUARE.point_at_vertex(25),
    "a place in the plane": lambda: SQUARE.closest_point([0.0, 0.0]),
    "a place nowhere": lambda: SQUARE.closest_point([0.0, np.nan, 0.0]),
    "half a corner vertex": corners_of(0.5, 1),
    "a corner beyond the last": corners_of(25, 1),
    "a corner inside": corners_of(12, 1),
    "half a corner": corners_of(0, 0.5),
    "a corner of no quad": corners_of(0, 2),
    "half a level": lambda: refine_at(SQUARE, [MIDDLE], 1.5),  # type: ignore[arg-type]
    "levels below none": lambda: refine_at(SQUARE, [MIDDLE], -1),
    "an angle that is none": lambda: sharp_edges(SQUARE, np.nan),
    "a negative distance": lambda: pair_at(SQUARE, [], MIDDLE, apart=-0.1),
    "a singularity beyond the last": lambda: split(SQUARE, [Singularity(MIDDLE, 8)], 1),
    "one before the first": lambda: merged(SQUARE, [Singularity(MIDDLE, 8)], -1, 0),
    "a fourth axis": lambda: mirrored(SQUARE, [], 3),
    "a turn that is none": lambda: rotated(SQUARE, [], 0, np.inf),
    "a negative weight of curvature": lambda: run(natural_singularities(SQUARE, weight=-1.0)),
    "half a seed": lambda: run(natural_singularities(SQUARE, seed=0.5)),  # type: ignore[arg-type]
    "no proximal weight": lambda: run(alternate(None, weight=0.0)),  # type: ignore[arg-type]
}


@pytest.mark.parametrize("call", REFUSED.values(), ids=REFUSED)
def test_bad_numbers_are_refused_in_one_line(call: Callable[[], object]) -> None:
    with pytest.raises(CrossviewError, match=r"\bmust be\b|not on the boundary") as refused:
        call()
    assert "\n" not in str(refused.value)


def test_whole_numbers_written_as_floats_are_whole() -> None:
    singularity = Singularity(MIDDLE, 3.0)  # type: ignore[arg-type]
    assert (singularity, singularity.index) == (Singularity(MIDDLE, 3), 1)
    assert TriSurface(CORNERS, [[0.0, 1.0, 2.0]]).faces.dtype == np.int64
    point = SurfacePoint(np.int64(2), (1, 0, 0))  # type: ignore[arg-type]
    assert point == SurfacePoint(2, (1.0, 0.0, 0.0))
