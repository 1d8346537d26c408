"""Features released until a field has its injective map: the last resort that always works."""

from __future__ import annotations

from collections.abc import Callable, Generator
from dataclasses import dataclass

import numpy as np

from solvers.features import Features, no_features
from solvers.fields import IntegratedField
from solvers.maps import MappedField, by_release
from solvers.progress import Progress, between
from solvers.surface import IntArray

ROUNDS = 6
"""Solves with ever fewer curves at most: less 1, 3, 7, 15, 31, then less all. Chosen."""

RESTORED = 3
"""Solves at most that look for how many of the curves last released are needed. Chosen."""


@dataclass(frozen=True, eq=False)
class Solved:
    """What a method makes of an aligned field.

    Parameters
    ----------
    integrated : IntegratedField
        The field that it finds.
    mapped : MappedField, or None
        The same with its map; None where it is not integrable, or a theorem says that it has none.
    """

    integrated: IntegratedField
    mapped: MappedField | None

    @property
    def injective(self) -> bool:
        """Whether there is a map, and nothing is wrong with it."""
        return self.mapped is not None and not self.mapped.faults

    def by_release(self) -> tuple[IntArray, ...]:
        """The curves that it follows, those to release first first, as of `by_release`."""
        return by_release(self.integrated, None if self.mapped is None else self.mapped.map)


Solving = Generator[Progress, None, Solved]
Solve = Callable[[Features], Solving]


def with_fewer_features(first: Solved, solve: Solve) -> Solving:
    """Release features until there is an injective map.

    Each round releases twice as many curves as the one before, those that `by_release` puts first
    for what was solved last; the last round releases all. Then as many of the last are followed
    again as can be.

    Parameters
    ----------
    first : Solved
        With all features, and without an injective map.
    solve : callable
        Takes the features of the surface solved on that are not to be followed; solves without.

    Returns
    -------
    Solved
        The first again if nothing helps.
    """
    last, without = first, no_features(first.integrated.aligned.prepared.surface)
    for number in range(1, ROUNDS + 1):
        curves = last.by_release()
        if not curves:
            return first
        given = curves if number == ROUNDS else curves[: 2 ** (number - 1)]
        last = yield from _solved(solve, without, given, number)
        if last.injective:
            return (yield from _restored(last, without, given, solve))
        without = without.united(np.concatenate(given))
    return first


def _restored(
    found: Solved, without: Features, given: tuple[IntArray, ...], solve: Solve
) -> Solving:
    """Release fewer of the curves given last, if fewer do, by bisection."""
    few, enough = 0, len(given)
    for number in range(RESTORED):
        if enough - few < 2:
            break
        tried = (few + enough) // 2
        other = yield from _solved(solve, without, given[:tried], ROUNDS + number)
        if other.injective:
            found, enough = other, tried
        else:
            few = tried
    return found


def _solved(solve: Solve, without: Features, given: tuple[IntArray, ...], number: int) -> Solving:
    """Solve without some and the curves given; each time half of the progress that is left."""
    released = without.united(np.concatenate(given))
    done = 1 - 0.5 ** (number - 1)
    yield Progress(f"solving without {len(released.curves)} feature curves", done)
    return (yield from between(solve(released), done, (1 + done) / 2))
