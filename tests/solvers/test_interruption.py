"""A factorisation is stopped as soon as anybody asks, and nothing else takes harm."""

import pytest

from solvers.algebra import factorized, stiffness
from solvers.interruption import Interrupted, Interruption, interruption
from solvers.primitives import disk


def test_it_is_obeyed_inside_alone() -> None:
    matrix = stiffness(disk(edge_length=0.25).triangulation)[1:, 1:]
    asked = Interruption()
    asked.ask()
    with asked.obeyed():
        assert interruption() is asked
        with pytest.raises(Interrupted):
            factorized(matrix)
    assert interruption() is not asked
    assert factorized(matrix).solve(matrix.diagonal()).any()


def test_who_listens_is_told_once_anybody_asks() -> None:
    told: list[str] = []
    asked = Interruption()
    with asked.telling(lambda: told.append("first")):
        assert told == []
        asked.ask()
        with asked.telling(lambda: told.append("late")):
            pass
    asked.ask()
    assert told == ["first", "late"]
    assert asked.asked
