"""Numbers that come in late, to finished fields and layouts, are refused in one line too."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from solvers.errors import CrossviewError
from solvers.fields import IntegratedField, IsotropicSolver, Limits, aligned_field, judge, prepare
from solvers.layouts import field_separatrices, quad_layout
from solvers.primitives import planar, square
from solvers.progress import run
from solvers.quads import fill, quantize, smooth
from solvers.repair import repair

ALIGNED = aligned_field(prepare(square(n=4)))
LAYOUT = run(quad_layout(IntegratedField(ALIGNED, ALIGNED.start)))
COUNTS = quantize(LAYOUT.tmesh, edge_length=1 / 3).counts
MESH = fill(LAYOUT, COUNTS)
FIELD = IsotropicSolver(square(n=4)).solve([])
UNBALANCED = COUNTS + np.arange(len(COUNTS))

WRONG: dict[str, tuple[Callable[[Any], object], Any]] = {
    "half counts": (lambda counts: fill(LAYOUT, counts), COUNTS + 0.5),
    "too few counts": (lambda counts: fill(LAYOUT, counts), COUNTS[:-1]),
    "negative counts": (lambda counts: fill(LAYOUT, counts), -COUNTS),
    "unbalanced counts": (lambda counts: fill(LAYOUT, counts), UNBALANCED),
    "counts in words": (lambda counts: fill(LAYOUT, counts), "three"),
    "windings that are no number": (lambda n: judge(FIELD, wrong_windings=n), np.nan),
    "windings in words": (lambda n: judge(FIELD, wrong_windings=n), "many"),
    "fewer inverted than none": (lambda inverted: judge(FIELD, inverted), -1),
    "half an inverted triangle": (lambda inverted: judge(FIELD, inverted), 0.5),
    "separatrices of no length": (lambda longest: field_separatrices(FIELD, longest), np.nan),
    "separatrices of negative length": (lambda longest: field_separatrices(FIELD, longest), -1),
    "a curve beyond the last vertex": (lambda curve: smooth(MESH, curves=[curve]), [0, 99]),
    "a curve of half a vertex": (lambda curve: smooth(MESH, curves=[curve]), [0.5, 1]),
    "a curve across triangles": (lambda curve: smooth(MESH, curves=[curve]), [0, 24]),
    "a curve of one vertex": (lambda curve: smooth(MESH, curves=[curve]), [3]),
    "a number for curves": (lambda curves: smooth(MESH, curves=curves), 3),
    "a number for a surface": (lambda vertices: repair(vertices, 4), 3),
    "corners beyond all numbers": (lambda x: planar(outer=[[0, 0], [x, 0], [0, 1]]), 10**400),
    "a field of another surface": (FIELD.turn_to, IsotropicSolver(square(n=6)).solve([])),
    "an angle below which nothing is": (lambda angle: Limits(angle=angle), 0.0),
    "an angle that is none": (lambda angle: Limits(angle=angle), np.nan),
    "a negative energy": (lambda energy: Limits(energy=energy), -1.0),
    "an energy in words": (lambda energy: Limits(energy=energy), "little"),
}


@pytest.mark.parametrize(("call", "value"), WRONG.values(), ids=WRONG)
def test_they_are_refused_in_one_line(call: Callable[[Any], object], value: Any) -> None:
    with pytest.raises(CrossviewError) as refused:
        call(value)
    assert "\n" not in str(refused.value)


def test_what_is_right_is_taken_however_it_is_written() -> None:
    assert fill(LAYOUT, COUNTS.astype(float).tolist()).n_quads == MESH.n_quads
    side = np.array([0, 1, 2, 3, 4])  # the lower side of the square
    assert smooth(MESH, curves=[side.tolist()]).n_quads == MESH.n_quads
