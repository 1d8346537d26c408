"""Surfaces glued of squares: what they have is possible, whatever any theorem says."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from random import Random


@dataclass(frozen=True)
class SquareTiled:
    """Squares with sides 0 to 3 counterclockwise; a side is glued to its partner or to itself.

    Side 4 f + k of square f runs from its corner k to the next; alone it is on the boundary.
    """

    partner: tuple[int, ...]

    @property
    def connected(self) -> bool:
        seen, waiting = {0}, [0]
        while waiting:
            square = waiting.pop()
            for side in range(4 * square, 4 * square + 4):
                neighbour = self.partner[side] // 4
                if neighbour not in seen:
                    seen.add(neighbour)
                    waiting.append(neighbour)
        return 4 * len(seen) == len(self.partner)

    def _around(self, side: int) -> tuple[list[int], int]:
        """Sides that leave a vertex, from `side` counterclockwise; the last one that enters it."""
        leaving = [side]
        while True:
            last = leaving[-1] // 4 * 4 + (leaving[-1] + 3) % 4
            following = self.partner[last]
            if following in (last, side):
                return leaving, last
            leaving.append(following)

    def boundaries(self) -> list[list[tuple[int, int]]]:
        """Each loop's sides, the surface on their left, with the index of the vertex they leave."""
        free = [side for side, other in enumerate(self.partner) if side == other]
        index, following = {}, {}
        for side in free:
            leaving, last = self._around(side)
            index[side], following[last] = 2 - len(leaving), side
        loops, left = [], set(free)
        while left:
            loop = [min(left)]
            while following[loop[-1]] != loop[0]:
                loop.append(following[loop[-1]])
            left -= set(loop)
            loops.append([(side, index[side]) for side in loop])
        return loops

    def configuration(self) -> tuple[int, list[list[int]], list[int]]:
        """Genus, corners of each boundary in order, indices inside."""
        loops = self.boundaries()
        done = {s for loop in loops for side, _ in loop for s in self._around(side)[0]}
        vertices, indices = sum(map(len, loops)), []
        for side in range(len(self.partner)):
            if side not in done:
                leaving, _ = self._around(side)
                done.update(leaving)
                vertices += 1
                indices.append(4 - len(leaving))
        edges = len({min(pair) for pair in enumerate(self.partner)})
        characteristic = vertices - edges + len(self.partner) // 4
        corners = [[k for _, k in loop if k] for loop in loops]
        return (2 - len(loops) - characteristic) // 2, corners, [k for k in indices if k]

    def handles(self) -> list[list[int]]:
        """Closed paths of squares, each the sides it leaves by, that together go around handles."""
        before: dict[int, list[int]] = {0: []}
        waiting, loops = [0], []
        for square in waiting:
            for side in range(4 * square, 4 * square + 4):
                neighbour = self.partner[side] // 4
                if neighbour not in before:
                    before[neighbour] = [*before[square], side]
                    waiting.append(neighbour)
        for side, other in enumerate(self.partner):
            out, back = before[side // 4], before[other // 4]
            if side < other and side not in back and other not in out:
                shared = sum(a == b for a, b in zip(out, back, strict=False))
                loops.append([*out[shared:], side, *(self.partner[s] for s in back[shared:][::-1])])
        crossings = [[self.crossings(one, other) for other in loops] for one in loops]
        return [loop for loop, row in zip(loops, crossings, strict=True) if any(row)]

    def turns_around(self, loop: list[int]) -> int:
        """Turns of the squares' axes against a closed path."""
        entered = [self.partner[side] for side in loop[-1:] + loop[:-1]]
        return sum(2 - (left - came) % 4 for came, left in zip(entered, loop, strict=True))

    def crossings(self, one: list[int], other: list[int]) -> int:
        """How often a closed path crosses another from its right to its left, less back."""
        crossed = [0] * len(self.partner)
        for side in other:
            crossed[side] += 1
            crossed[self.partner[side]] -= 1
        total = 0
        for came, left in zip([self.partner[s] for s in one[-1:] + one[:-1]], one, strict=True):
            corner = came // 4 * 4
            total += sum(crossed[corner + (came + n) % 4] for n in range((left - came) % 4))
            total += crossed[left]
        return total

    def turning(self, start: int, end: int) -> int:
        """Turns of the squares' axes against a shortest path from one free side to another."""
        before = {start // 4: (start, 0)}
        waiting = [start // 4]
        for square in waiting:
            entered, turned = before[square]
            for step in (1, 2, 3):  # to the right side, straight on, to the left
                side = square * 4 + (entered + step) % 4
                after = turned + 2 - step
                if side == end:
                    return after
                neighbour = self.partner[side]
                if neighbour != side and neighbour // 4 not in before:
                    before[neighbour // 4] = (neighbour, after)
                    waiting.append(neighbour // 4)
        raise AssertionError("the sides are not connected")


def glued_at_random(random: Random, squares: int, free: int) -> SquareTiled:
    """Return squares with all sides but some glued in random pairs."""
    sides = list(range(4 * squares))
    random.shuffle(sides)
    partner = list(range(4 * squares))
    for a, b in zip(sides[free::2], sides[free + 1 :: 2], strict=True):
        partner[a], partner[b] = b, a
    return SquareTiled(tuple(partner))


def every_gluing(squares: int, boundary: bool) -> Iterator[SquareTiled]:
    """Yield all connected gluings, with or without sides left free."""

    def pair(partner: dict[int, int], left: Sequence[int]) -> Iterator[dict[int, int]]:
        if not left:
            yield partner
            return
        first, rest = left[0], left[1:]
        if boundary:
            yield from pair({**partner, first: first}, rest)
        for i, other in enumerate(rest):
            both = {**partner, first: other, other: first}
            yield from pair(both, [*rest[:i], *rest[i + 1 :]])

    for partner in pair({}, range(4 * squares)):
        found = SquareTiled(tuple(partner[side] for side in range(4 * squares)))
        if found.connected:
            yield found


def ring(columns: Sequence[tuple[int, int]]) -> SquareTiled:
    """Return columns of squares, each from a height to another, side by side around a cylinder."""
    places = [(i, y) for i, (low, high) in enumerate(columns) for y in range(low, high)]
    number = {place: f for f, place in enumerate(places)}
    partner = list(range(4 * len(places)))
    for (i, y), f in number.items():
        for other, side, back in (
            (((i + 1) % len(columns), y), 1, 3),
            ((i, y + 1), 2, 0),
        ):
            if other in number:
                partner[4 * f + side] = 4 * number[other] + back
                partner[4 * number[other] + back] = 4 * f + side
    return SquareTiled(tuple(partner))
