"""Whether any quad mesh has given singularities and corners: decided by topology alone.

A quad mesh is a flat metric whose cone angles are whole quarter turns, with holonomy in quarter
turns and a boundary along its axes: a quartic differential, real on the boundary, with a zero of
order -k where the index is k. The question is whether there is one, of any shape.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import accumulate
from math import gcd
from typing import Literal

from solvers.errors import SingularityError
from solvers.number_checks import whole_number, whole_numbers
from solvers.singularities.theorems import (
    ANNULUS_TURNS,
    BUDGET,
    CLOSED_TURNS,
    EMPTY_STRATUM,
    FLAT_ANNULUS,
    FLAT_TORUS,
    ONE_WAY,
    SPIN,
    TORUS_PAIR,
    TORUS_TURNS,
    ZIGZAG,
    Theorem,
)

Answer = Literal["possible", "impossible", "undecided"]

FULL = 4
"""Quarter turns of a full one. From theory."""


def decide(
    genus: int,
    boundaries: Sequence[Sequence[int]],
    indices: Iterable[int],
    turns: Sequence[int] | None = None,
) -> tuple[Answer, Theorem | None]:
    """Decide whether any quad mesh has given indices, on any surface of a topology.

    Parameters
    ----------
    genus : int
        Number of handles.
    boundaries : sequence of sequence of int
        The indices of the corners of each boundary loop, in the order in which the loop meets them
        with the surface on its left; zeros are regular.
    indices : iterable of int
        Of the singularities inside; zeros are regular.
    turns : sequence of int, optional
        Quarter turns, counterclockwise, of the crosses against each of 2 ``genus`` handle loops,
        two by two crossing each other once and no other, then against a path to each further
        boundary, from a place before the first corner of the first boundary to one before the
        first corner of the further one. By default any.

    Returns
    -------
    answer : {"possible", "impossible", "undecided"}
        "undecided" only where turns are given, on surfaces with boundary that are no disk and no
        annulus.
    theorem : Theorem or None
        What forbids it.

    Raises
    ------
    SingularityError
        An index is none of a point inside, or of a corner, or the turns are too few or too many.

    Notes
    -----
    Spheres and disks have no holonomy, so that the budget is enough: the quartic differential
    prod (z - z_i)^-k_i dz^4 is there, at any places. On a torus Abel's theorem asks that
    sum k_i z_i is a period, the greatest common divisor of the k_i times a torsion point whose
    order the turns tell; two points that do not differ have none. On closed surfaces of
    higher genus no stratum of quartic differentials with such orders is empty (Jucovic and
    Trenkler 1973 for valences from 3; Gendron and Tahar 2022 in general). With turns: what counts
    is whether they and the indices are all whole (abelian differentials), half (quadratic) or
    only quarter turns, and on surfaces of whole turns the Arf invariant. The empty ones are of
    genus 2: of half turns Q(4) and Q(3, 1), of whole ones H(2) with an even spin structure.

    An annulus is conformally a cylinder. Let T(phi) be the turns along the path across it at the
    angle phi, whole numbers that jump by k where a singularity or a corner is passed. Integrating
    the conjugate of H over paths gives that the mean of T over phi is zero, and any such T has its
    field. Without singularities T is ``turns`` plus the sums of corners passed on the one boundary
    less those on the other, and the mean of such sums may be anything between their extremes: of
    corners + - + - ... opposite a straight boundary between 0 and 1, never whole.

    Surfaces with more boundaries or with handles: the indices are doubled and the double is a
    closed surface, of genus 2 at least. All small square-tiled surfaces were enumerated; the only
    budget without any is that whose double has the orders 6 and 2 and quadratic holonomy. With
    turns, boundaries that bound a polygon cut out of a surface may be left out. What counts of the
    others is the greatest common divisor of the turns around closed loops (of genus 1, else with
    4). All small classes where it is 1, or where planar ones have singularities, were found; of
    others some were not. Where all turns around closed loops are whole, each side of the boundary
    has one of four directions, and by Stokes' theorem the displacements along all sides sum to
    zero.

    Examples
    --------
    >>> from solvers.singularities import decide
    >>> answer, theorem = decide(1, [], [1, -1, 0])
    >>> print(answer, theorem)
    impossible No quadrangulation of a torus has one valence 3, one valence 5 and nothing else (...
    >>> decide(0, [[1, -1, 1, -1], []], [])[0], decide(0, [[1, 1, -1, -1], []], [])[0]
    ('impossible', 'possible')
    >>> decide(0, [[1, 1, -1, -1], []], [], turns=[1])[0]
    'impossible'
    >>> [decide(1, [], [2, -2], turns)[0] for turns in ([0, 2], [0, 1])]
    ['impossible', 'possible']
    """
    inside = sorted(_checked("a singularity", indices, 3))
    loops = [_checked("a corner", loop, 1) for loop in boundaries]
    given = None if turns is None else _checked_turns(turns, genus, len(loops))
    if sum(inside) + sum(map(sum, loops)) != FULL * (2 - 2 * genus - len(loops)):
        return "impossible", BUDGET
    match genus, len(loops):
        case 0, 0 | 1:
            return "possible", None
        case 1, 0:
            return _on_torus(inside, given)
        case 0, 2:
            return _on_annulus(loops, inside, given)
        case _, 0:
            theorem = None if given is None else _closed(genus, inside, given)
            return ("possible" if theorem is None else "impossible"), theorem
        case _:
            return _bounded(genus, loops, inside, given)


def _checked(of: str, indices: Iterable[int], most: int) -> list[int]:
    """Return the indices that are not 0."""
    whole = (
        whole_number(f"the index of {of}", k, most=most, error=SingularityError) for k in indices
    )
    return [k for k in whole if k]


def _checked_turns(turns: Sequence[int], genus: int, n_boundaries: int) -> list[int]:
    wanted = 2 * genus + max(n_boundaries - 1, 0)
    given = whole_numbers("the turns", turns, (wanted,), error=SingularityError)
    return [int(n) for n in given]


def _on_torus(inside: Sequence[int], turns: Sequence[int] | None) -> tuple[Answer, Theorem | None]:
    if not inside:
        return ("impossible", FLAT_TORUS) if any(turns or ()) else ("possible", None)
    if inside == [-1, 1]:
        return "impossible", TORUS_PAIR
    if turns is not None and len(inside) == 2 and gcd(*inside, *turns) == inside[1]:
        return "impossible", TORUS_TURNS
    return "possible", None


def _closed(genus: int, inside: Sequence[int], turns: Sequence[int]) -> Theorem | None:
    """Return what forbids the turns on a closed surface of genus 2 at least."""
    if genus != 2:
        return None
    part = gcd(FULL, *inside, *turns)
    if part == 2 and inside in ([-8], [-6, -2]):
        return CLOSED_TURNS
    return SPIN if part == FULL and inside == [-8] and not _arf(turns) else None


def _arf(turns: Sequence[int]) -> int:
    """Return the Arf invariant of whole turns around pairs of loops (Johnson 1980)."""
    odd = [(n // FULL + 1) % 2 for n in turns]
    return sum(a * b for a, b in zip(odd[::2], odd[1::2], strict=True)) % 2


def _on_annulus(
    loops: Sequence[Sequence[int]], inside: Sequence[int], turns: Sequence[int] | None
) -> tuple[Answer, Theorem | None]:
    if inside or sum(loops[0]):  # one singularity, or boundary, turned about the axis: any mean
        return "possible", None
    if not any(loops):
        return ("impossible", FLAT_ANNULUS) if any(turns or ()) else ("possible", None)
    first, second = ([0, *accumulate(loop)] for loop in loops)
    low, high = min(second) - max(first), max(second) - min(first)
    if high - low < 2:
        return "impossible", ZIGZAG
    if turns is None or low < turns[0] < high:
        return "possible", None
    return "impossible", ANNULUS_TURNS


def _bounded(
    genus: int,
    loops: Sequence[Sequence[int]],
    inside: Sequence[int],
    turns: Sequence[int] | None,
) -> tuple[Answer, Theorem | None]:
    if genus == 0 and not inside and sorted(map(sorted, loops)) == [[], [], [-3, -1]]:
        return "impossible", EMPTY_STRATUM
    if turns is None:
        return "possible", None
    around, across = turns[: 2 * genus], turns[2 * genus :]
    if _cut_out(genus, loops, inside, around, across):
        return "possible", None
    # A loop that is moved over a singularity, or a boundary, turns by its index more, or less.
    part = gcd(*inside, *(sum(loop) + FULL for loop in loops), *around)
    part = part if genus == 1 else gcd(FULL, part)
    if part == 1 or (genus == 0 and inside and part < FULL):
        return "possible", None
    if part % FULL:
        return "undecided", None
    directions: set[int] = set()
    for loop, first in zip(loops, [0, *(2 - n for n in across)], strict=True):
        directions.update(n % FULL for n in accumulate(loop, initial=first))
    if any((n in directions) != ((n + 2) % FULL in directions) for n in (0, 1)):
        return "impossible", ONE_WAY
    return "undecided", None


def _cut_out(
    genus: int,
    loops: Sequence[Sequence[int]],
    inside: Sequence[int],
    around: Sequence[int],
    across: Sequence[int],
) -> bool:
    """Return whether it is known to be possible without those holes that bound a polygon."""
    hole = [sum(loop) == -FULL and min(loop) >= -2 for loop in loops]
    if all(hole):
        return decide(genus, [], inside, around)[0] == "possible"
    if hole[0] or not any(hole):
        return False
    kept = [i for i, cut in enumerate(hole) if not cut]
    turns = [*around, *(across[i - 1] for i in kept[1:])]
    return decide(genus, [loops[i] for i in kept], inside, turns)[0] == "possible"
