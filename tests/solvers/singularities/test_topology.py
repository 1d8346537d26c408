"""Possible and impossible, against surfaces glued of squares and against theorems."""

from __future__ import annotations

from collections import Counter
from random import Random

import pytest

from solvers.errors import SingularityError
from solvers.primitives import annulus, square, torus
from solvers.singularities.budget import Singularity
from solvers.singularities.decision import existence
from solvers.singularities.remedies import AddMissing, AddPair, ChangeCorners, ChangeTurns
from solvers.singularities.theorems import (
    ANNULUS_TURNS,
    BUDGET,
    EMPTY_STRATUM,
    FLAT_ANNULUS,
    FLAT_TORUS,
    TORUS_PAIR,
    ZIGZAG,
    Theorem,
)
from solvers.singularities.topology import decide
from tests.solvers.singularities.square_tiled import (
    SquareTiled,
    every_gluing,
    glued_at_random,
    ring,
)

Row = tuple[int, tuple[tuple[int, ...], ...], tuple[int, ...]]


def row(surface: SquareTiled) -> Row:
    genus, corners, indices = surface.configuration()
    return genus, tuple(sorted(map(tuple, corners))), tuple(sorted(indices))


def random_rings(number: int) -> list[SquareTiled]:
    """Annuli without singularities, whose boundaries go up and down."""
    random = Random(3)
    found: list[SquareTiled] = []
    while len(found) < number:
        lows = [random.randint(-2, 1) for _ in range(random.randint(1, 7))]
        columns = [(low, low + random.randint(1, 3)) for low in lows]
        pairs = zip(columns, columns[1:] + columns[:1], strict=True)
        if all(max(a[0], b[0]) < min(a[1], b[1]) for a, b in pairs):
            found.append(ring(columns))
    return found


@pytest.fixture(scope="module")
def possible() -> set[Row]:
    """Configurations that there are, for somebody glued them."""
    random, found = Random(1), set[Row]()
    while len(found) < 600:
        squares = random.randint(1, 7)
        surface = glued_at_random(random, squares, 2 * random.randint(0, squares + 1))
        if surface.connected:
            found.add(row(surface))
    return found | {row(surface) for surface in random_rings(200)}


def impossible() -> list[tuple[Row, Theorem]]:
    """Configurations that a theorem forbids."""
    rows: list[tuple[Row, Theorem]] = []
    rows += [((1, (), (-1, *[0] * n, 1)), TORUS_PAIR) for n in range(6)]
    for teeth in range(1, 7):
        for zigzag in ((1, -1) * teeth, (-1, 1) * teeth):
            rows += [((0, loops, ()), ZIGZAG) for loops in (((), zigzag), (zigzag, (0,)))]
    for corners in ((-3, -1), (-1, -3), (-3, 0, -1)):
        for place in range(3):
            loops = ((),) * place + (corners,) + ((),) * (2 - place)
            rows.append(((0, loops, ()), EMPTY_STRATUM))
    return rows


def test_no_configuration_that_there_is_is_called_impossible(possible: set[Row]) -> None:
    answers = Counter(decide(*given)[0] for given in possible)
    assert answers == {"possible": len(possible)}
    kinds = {(genus, len(loops)) for genus, loops, _ in possible}
    assert {(0, 0), (0, 1), (0, 2), (0, 3), (1, 0), (1, 1), (1, 2), (2, 0), (2, 1)} <= kinds


def test_none_that_a_theorem_forbids_is_called_possible(possible: set[Row]) -> None:
    for given, theorem in impossible():
        assert decide(*given) == ("impossible", theorem)
        assert given not in possible


def test_none_that_misses_the_budget_is_called_possible(possible: set[Row]) -> None:
    random = Random(2)
    for genus, loops, indices in sorted(possible)[::3]:
        off = random.choice([-4, -3, -2, -1, 1, 2, 3])
        assert decide(genus, loops, (*indices, off)) == ("impossible", BUDGET)
        assert decide(genus + 1, loops, indices) == ("impossible", BUDGET)


def test_all_gluings_of_a_few_squares_have_no_more_exceptions() -> None:
    """Of three squares there is a torus of each budget of valences 1 to 7, but not of 3 and 5."""
    found = Counter(row(surface) for surface in every_gluing(3, boundary=False))
    assert all(decide(*given)[0] == "possible" for given in found)
    tori = {indices for genus, _, indices in found if genus == 1}
    valences = [k for k in range(-3, 4) if k]  # three squares on a torus have three vertices
    sums: list[tuple[int, ...]] = [(), *((-k, k) for k in (1, 2, 3))]
    sums += [(a, b, c) for a in valences for b in valences for c in valences if a + b + c == 0]
    budgets = {tuple(sorted(indices)) for indices in sums}
    assert budgets - tori == {(-1, 1)}
    assert {indices for genus, _, indices in found if genus == 2} == {(-8,)}


def test_all_gluings_of_two_squares_with_boundary_are_possible() -> None:
    found = {row(surface) for surface in every_gluing(2, boundary=True)}
    assert len(found) > 20
    assert all(decide(*given)[0] == "possible" for given in found)


def test_singularities_of_valence_4_and_straight_corners_count_for_nothing() -> None:
    assert decide(1, [], [0, 1, 0, -1, 0]) == ("impossible", TORUS_PAIR)
    assert decide(0, [[0, 1, 0, -1], [0]], [0]) == ("impossible", ZIGZAG)
    assert decide(1, [], [0, 0]) == ("possible", None)


def test_answers_depend_on_no_start_order_or_side(possible: set[Row]) -> None:
    """Nor on which way round all loops are read: a mirror image is as possible."""
    random = Random(5)
    rows = [given for given, _ in impossible()] + sorted(possible)[::5]
    for genus, loops, indices in rows:
        starts = [random.randint(0, max(len(loop) - 1, 0)) for loop in loops]
        turned = [loop[i:] + loop[:i] for i, loop in zip(starts, loops, strict=True)]
        mirrored = [loop[::-1] for loop in loops]
        same = {decide(genus, given, indices)[0] for given in (loops, turned, mirrored)}
        assert len(same) == 1
        assert decide(genus, loops[::-1], indices[::-1])[0] in same


def test_corners_to_and_fro_become_possible_with_a_pair_inside_or_opposite_ones() -> None:
    for teeth in (1, 2, 3):
        zigzag = [1, -1] * teeth
        assert decide(0, [zigzag, []], [])[0] == "impossible"
        assert decide(0, [zigzag, []], [1, -1])[0] == "possible"
        assert decide(0, [zigzag, [1, -1]], [])[0] == "possible"
        assert decide(0, [[*zigzag, -1, 1], []], [])[0] == "possible"


def test_turns_of_glued_annuli_are_among_those_that_are_possible() -> None:
    """The turns are counted along a path of squares; from any places of both boundaries."""
    random = Random(4)
    for surface in random_rings(150):
        first, second = surface.boundaries()
        starts = [random.randrange(len(loop)) for loop in (first, second)]
        ends, corners = [], []
        for start, loop in zip(starts, (first, second), strict=True):
            around = loop[start:] + loop[:start]
            ends.append(around[0][0])
            corners.append([k for _, k in around[1:] + around[:1]])
        turns = surface.turning(*ends)
        assert decide(0, corners, [], [turns])[0] == "possible"


def test_turns_by_which_the_boundaries_part_are_impossible() -> None:
    """Both boundaries are displaced by the same vector, a sum of their sides of any lengths."""
    loops = [[], [1, 1, -1, -1], [1, -1], [1, -1, -1, 1], [-1, -1, 1, 1], [1, 1, 1, -1, -2]]
    found = Counter[str]()
    for first in loops:
        for second in loops:
            for turns in range(-4, 5):
                answer, theorem = decide(0, [first, second], [], [turns])
                found[answer] += 1
                if answer == "possible":
                    assert signs(first, 0) & signs(second, -turns)
                    assert signs(first, 1) & signs(second, 1 - turns)
                else:
                    assert theorem in (FLAT_ANNULUS, ZIGZAG, ANNULUS_TURNS)
    assert min(found["possible"], found["impossible"]) > 50


def signs(corners: list[int], turned: int) -> set[int]:
    """Of the displacement along the first axis, sides of any positive lengths."""
    direction, along = turned, set[int]()
    for k in [0, *corners]:
        direction += k
        along |= {(1, 0, -1, 0)[direction % 4]} - {0}
    return {-1, 0, 1} if along == {-1, 1} else along or {0}


def test_a_flat_torus_and_a_cylinder_have_no_turns() -> None:
    for turns in ([1, 0], [0, -2], [4, 0]):
        assert decide(1, [], [], turns) == ("impossible", FLAT_TORUS)
        assert decide(1, [], [1, 1, -2], turns)[0] == "possible"
    assert decide(1, [], [], [0, 0])[0] == "possible"
    for turn in (-4, -1, 2):
        assert decide(0, [[], []], [], [turn]) == ("impossible", FLAT_ANNULUS)
        assert decide(0, [[], []], [1, -1], [turn])[0] == "possible"
    assert decide(0, [[], []], [], [0])[0] == "possible"


def test_where_only_some_turns_are_possible_any_may_be_meant() -> None:
    assert decide(1, [], [2, -2])[0] == "possible"
    assert decide(1, [], [2, -2], [0, 0])[0] == "impossible"
    assert decide(1, [], [2, -2], [0, 1])[0] == "possible"


@pytest.mark.parametrize("given", [([4, -4], []), ([], [[2], [-2]]), ([0.5, -0.5], [])])
def test_indices_that_nothing_has_are_refused(
    given: tuple[list[float], list[list[int]]],
) -> None:
    indices, loops = given
    with pytest.raises(SingularityError):
        decide(1, loops, indices)  # type: ignore[arg-type]


def test_remedies_lead_to_what_is_possible() -> None:
    plate = annulus(n=24)
    inner = plate.boundary_loops[1].tolist()
    for corners in ({inner[0]: 1, inner[3]: -1}, {inner[i]: (-1) ** i for i in range(4)}):
        found = existence(plate, [], corners)
        assert found.theorem is ZIGZAG
        pair, straight = found.remedies
        assert isinstance(pair, AddPair)
        ends = [Singularity(plate.point_at_vertex(v), n) for v, n in ((50, 3), (90, 5))]
        assert existence(plate, ends, corners).answer == "possible"
        assert isinstance(straight, ChangeCorners)
        assert existence(plate, [], corners | dict(straight.corners)).answer == "possible"
    ring_around = torus(n=12)
    found = existence(ring_around, [], {}, [2, -1])
    (turns,) = found.remedies
    assert isinstance(turns, ChangeTurns)
    assert turns.by == (-2, 1)
    assert isinstance(existence(square(n=2), [], {}).remedies[0], AddMissing)


def test_the_order_of_corners_is_that_of_the_boundary_not_of_the_mapping() -> None:
    plate = annulus(n=24)
    a, b, c, d = plate.boundary_loops[0][[0, 3, 6, 9]].tolist()
    assert existence(plate, [], {a: 1, c: 1, b: -1, d: -1}).answer == "impossible"
    assert existence(plate, [], {a: 1, b: 1, c: -1, d: -1}).answer == "possible"


def test_a_torus_with_a_valence_4_besides_3_and_5_is_impossible() -> None:
    surface = torus(n=12)
    places = [(0, 3), (40, 5), (70, 4)]
    placed = [Singularity(surface.point_at_vertex(v), n) for v, n in places]
    assert existence(surface, placed, {}).theorem is TORUS_PAIR


def test_turns_that_part_the_boundaries_are_mended_by_the_nearest_that_do_not() -> None:
    plate = annulus(n=24)
    a, b, c, d = plate.boundary_loops[0][[1, 3, 6, 9]].tolist()
    corners = {a: 1, b: 1, c: -1, d: -1}
    for turns in (-3, -2, 0, 1):
        found = existence(plate, [], corners, [turns])
        assert found.theorem is ANNULUS_TURNS
        change = found.remedies[0]
        assert isinstance(change, ChangeTurns)
        assert existence(plate, [], corners, [turns + change.by[0]]).answer == "possible"
