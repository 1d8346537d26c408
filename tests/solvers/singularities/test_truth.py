"""A table of what is known to be possible or impossible, with turns, against `decide`.

Possible is what somebody glued of squares; impossible is what misses the budget, what a theorem
forbids, and what sides of any lengths cannot close.
"""

from __future__ import annotations

from collections import Counter
from itertools import product
from math import gcd
from random import Random

import pytest

from solvers.fields.turning import paired
from solvers.singularities.topology import decide
from tests.solvers.singularities.square_tiled import SquareTiled, every_gluing, glued_at_random

Row = tuple[int, tuple[tuple[int, ...], ...], tuple[int, ...], tuple[int, ...]]


def known(surface: SquareTiled, random: Random) -> Row:
    """Genus, corners, indices and turns of a surface that is there."""
    genus, _, indices = surface.configuration()
    loops = surface.boundaries()
    starts = [random.randrange(len(loop)) for loop in loops]
    loops = [loop[i:] + loop[:i] for i, loop in zip(starts, loops, strict=True)]
    corners = [tuple(k for _, k in loop[1:] + loop[:1]) for loop in loops]
    across = [surface.turning(loops[0][0][0], loop[0][0]) for loop in loops[1:]]
    return genus, tuple(corners), tuple(indices), (*around(surface, genus), *across)


def around(surface: SquareTiled, genus: int) -> tuple[int, ...]:
    """Turns around pairs of handle loops, up to those that others of the same surface have."""
    loops = surface.handles()
    turns = [surface.turns_around(loop) for loop in loops]
    crossings = [[surface.crossings(one, other) for other in loops] for one in loops]
    if genus == 1:
        return next(
            (turns[i], turns[j])
            for i, row in enumerate(crossings)
            for j, crossed in enumerate(row)
            if abs(crossed) == 1
        )
    if any(n % 4 for n in turns):  # from genus 2 on no more than the common part counts
        return (gcd(4, *turns), *[0] * (2 * genus - 1))
    return paired(turns, crossings)


@pytest.fixture(scope="module")
def possible() -> set[Row]:
    random, found = Random(11), set[Row]()
    found |= {known(s, random) for s in every_gluing(3, boundary=False)}
    while len(found) < 900:
        squares = random.randint(1, 7)
        surface = glued_at_random(random, squares, 2 * random.randint(0, squares + 1))
        if surface.connected:
            found.add(known(surface, random))
    return found


def tori() -> set[Row]:
    """Of two indices k and -k, the turns multiples of k; of none, any turns."""
    pairs = [(a, b) for a, b in product(range(-3, 4), repeat=2)]
    rows: set[Row] = {(1, (), (0,) * n, pair) for pair in pairs for n in (0, 2) if any(pair)}
    for k in (1, 2, 3):
        for a, b in pairs:
            rows |= {(1, (), (k, 0, -k), (k * a, k * b)), (1, (), (-k, k), (k * b, k * a))}
    return rows


def genus_two() -> set[Row]:
    """Of half turns Q(4) and Q(3, 1), of whole turns H(2) of even spin."""
    rows: set[Row] = set()
    for half in product((-2, 0, 2, 4), repeat=4):
        if any(n % 4 for n in half):
            rows |= {(2, (), (-8,), half), (2, (), (-2, 0, -6), half)}
    for whole in product((0, 4, 8), repeat=4):
        a, b, c, d = (n // 4 + 1 for n in whole)
        if (a * b + c * d) % 2 == 0:
            rows.add((2, (), (-8,), whole))
    return rows


def one_way() -> set[Row]:
    """Turns for which the sides of the boundaries, of any lengths, never close.

    Flat: all loops turn by whole turns, so that each side has its direction.
    """
    rows: set[Row] = set()
    shapes: list[tuple[int, tuple[tuple[int, ...], ...], tuple[int, ...]]] = [
        (0, ((), ()), ()),
        (0, ((1, 1, -1, -1), ()), ()),
        (0, ((1, -1), (1, -1)), ()),
        (0, ((), (-1, -1, 1, 1)), ()),
        (0, ((), (), (-4,)), ()),
        (0, ((-4,), (), ()), ()),
        (0, ((), (-2, -2), ()), ()),
        (0, ((), (), ()), (-4,)),
        (1, ((),), (-4,)),
        (1, ((-4,),), ()),
        (1, ((-3, -1),), ()),
        (1, ((), ()), (-8,)),
        (1, ((), ()), (-4, -4)),
        (1, ((), (-4,)), (-4,)),
    ]
    for genus, loops, indices in shapes:
        for across in product(range(-3, 4), repeat=len(loops) - 1):
            sides = [
                (n + sum(loop[:i])) % 4
                for n, loop in zip((0, *(2 - n for n in across)), loops, strict=True)
                for i in range(len(loop) + 1)
            ]
            if any((n in sides) != ((n + 2) % 4 in sides) for n in range(4)):
                for whole in ((0, 0), (4, 0), (-4, 8))[: 1 + 2 * genus]:
                    rows.add((genus, loops, indices, (*whole[: 2 * genus], *across)))
    return rows


def straight() -> set[Row]:
    """Corners to and fro opposite a straight boundary, and an empty stratum."""
    rows: set[Row] = set()
    for teeth, turns in product((1, 2, 3), range(-2, 3)):
        for zigzag in ((1, -1) * teeth, (-1, 1) * teeth):
            rows |= {(0, (zigzag, ()), (), (turns,)), (0, ((0,), zigzag), (0,), (turns,))}
    for one, other in product(range(4), repeat=2):
        for corners in ((-3, -1), (-1, -3)):
            rows.add((0, ((), corners, ()), (), (one, other)))
    return rows


IMPOSSIBLE = [tori(), genus_two(), one_way(), straight()]


def test_the_table_is_long_and_of_every_kind(possible: set[Row]) -> None:
    kinds = Counter((genus, min(len(loops), 3)) for genus, loops, _, _ in possible)
    wanted = {(0, 0), (0, 1), (0, 2), (0, 3), (1, 0), (1, 1), (1, 2), (2, 0), (2, 1), (3, 0)}
    assert wanted <= set(kinds)
    assert sum(map(len, IMPOSSIBLE)) > 600
    assert min(map(len, IMPOSSIBLE)) > 60


def test_nothing_that_there_is_is_called_impossible_and_little_is_undecided(
    possible: set[Row],
) -> None:
    found = Counter(decide(*row)[0] for row in possible)
    assert found["impossible"] == 0
    assert found["undecided"] < 0.02 * (len(possible) + sum(map(len, IMPOSSIBLE)))
    assert found["undecided"] < 0.04 * len(possible)
    assert {decide(*row[:3])[0] for row in possible} == {"possible"}


@pytest.mark.parametrize("rows", IMPOSSIBLE)
def test_nothing_that_is_impossible_is_called_possible(rows: set[Row], possible: set[Row]) -> None:
    for row in rows:
        answer, theorem = decide(*row)
        assert answer == "impossible", row
        assert theorem is not None
    assert not rows & possible


def test_what_misses_the_budget_is_impossible_whatever_the_turns(possible: set[Row]) -> None:
    random = Random(12)
    for genus, loops, indices, turns in sorted(possible)[::2]:
        off = random.choice([-4, -3, -2, -1, 1, 2, 3])
        assert decide(genus, loops, (*indices, off), turns)[0] == "impossible"


def test_no_surface_of_squares_has_what_is_empty() -> None:
    """All gluings of three squares, and closed ones of more at random."""
    random, seen = Random(13), Counter[tuple[int, ...]]()
    surfaces = list(every_gluing(3, boundary=False))
    surfaces += [glued_at_random(random, random.randint(3, 6), 0) for _ in range(2000)]
    for surface in surfaces:
        if surface.connected:
            genus, _, indices, turns = known(surface, random)
            if genus == 2 and sorted(indices) in ([-8], [-6, -2]):
                seen[(*sorted(indices), gcd(4, *turns))] += 1
    assert seen[-8, 1] > 0
    assert seen[-8, 4] > 0
    assert seen[-6, -2, 1] > 0
    assert seen[-8, 2] == seen[-6, -2, 2] == 0


def test_turns_around_a_handle_may_be_changed_by_any_index_moved_over() -> None:
    """Twists, and singularities carried around: what decides does not depend on the loops."""
    random = Random(14)
    for row in random.sample(sorted(tori() | genus_two()), 150):
        genus, loops, indices, turns = row
        a, b, *rest = turns
        moved = random.choice(indices or (0,))
        assert decide(genus, loops, indices, (a + b, b, *rest))[0] == "impossible"
        if genus == 1:
            assert decide(genus, loops, indices, (b, a + 2 * moved))[0] == "impossible"
