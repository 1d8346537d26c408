"""The values a case is made of. Each field says what its key in a case file is like."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, ClassVar

from crossview.cases.compounds import Either, ListOf
from crossview.cases.json_values import CaseError, known_word
from crossview.cases.records import check_numbers, documented, key
from crossview.cases.scalars import File, Flag, Number, Word
from solvers.fields import TOLERANCE_DEGREES
from solvers.number_checks import real_numbers, whole_numbers
from solvers.surface import LEVELS

METHODS = ("isotropic", "aligned", "anisotropic", "alternating")
"""The methods there are, the default first."""

MOST_REFINE = 10
"""Levels of refinement after which triangles at a singularity are a thousandth of the others."""

MOST_VALENCE = 100
"""Quads that meet in one vertex; more is a slip of the pen."""

Sizes = str | tuple[float, ...] | tuple[tuple[float, float], ...]
"""A size map: its file, or a size or a pair of sizes for each vertex."""

Position = tuple[float, float, float]

Polyline = tuple[Position, ...]

POSITION = ListOf(Number(), length=3, name="points [x, y, z]")
"""How a case gives a point."""

POLYLINES = ListOf(ListOf(POSITION, least=2, name="polylines, each of 2 or more points [x, y, z]"))
"""How a case gives curves."""

SIZE = Number(above=0)
"""How a case gives a size."""


@documented
@dataclass(frozen=True)
class PlacedSingularity:
    """A singularity given by a point of space."""

    position: Position = field(
        metadata=key(POSITION, "Moved to the nearest point of the surface, which may not be far.")
    )
    valence: int = field(
        metadata=key(
            Number(whole=True, least=1, most=MOST_VALENCE),
            "Number of quads that meet there; its index is 4 - valence.",
        )
    )
    locked: bool = field(default=False, metadata=key(Flag(), "Whether it is kept in place."))

    def __post_init__(self) -> None:
        check_numbers(self)
        object.__setattr__(self, "position", _position(self.position))


@documented
@dataclass(frozen=True)
class PlacedCorner:
    """A boundary vertex, given by a point of space, where the field turns."""

    position: Position = field(metadata=key(POSITION, "Moved to the nearest boundary vertex."))
    index: int = field(
        metadata=key(
            Number(whole=True, least=2 - MOST_VALENCE, most=1),
            "2 - number of quads that meet there: 1 at 90 degrees, -1 at 270.",
        )
    )

    def __post_init__(self) -> None:
        check_numbers(self)
        object.__setattr__(self, "position", _position(self.position))


@documented
@dataclass(frozen=True)
class PlacedFeatures:
    """Edges inside the surface that crosses are to follow."""

    dihedral_degrees: float | None = field(
        default=None,
        metadata=key(
            Number(above=0, most=180),
            "Edges over which the surface bends by more than this are features.",
        ),
    )
    curves: tuple[Polyline, ...] = field(
        default=(),
        metadata=key(
            POLYLINES,
            "More of them: each runs along edges, the shortest way, through the vertices nearest "
            "to its points.",
        ),
    )
    without: tuple[Polyline, ...] = field(
        default=(),
        metadata=key(POLYLINES, "Edges, given likewise, that are none although they are sharp."),
    )

    def __post_init__(self) -> None:
        check_numbers(self)


@documented
@dataclass(frozen=True)
class Options:
    """What may be tuned."""

    RETIRED: ClassVar = ("verify",)
    """Keys of files from before, read over: growth under refinement tells less than topology."""

    tolerance_degrees: float = field(
        default=TOLERANCE_DEGREES,
        metadata=key(
            Number(above=0, most=45),
            "Largest holonomy defect of a configuration called valid, degrees.",
        ),
    )
    refine: int = field(
        default=LEVELS,
        metadata=key(
            Number(whole=True, least=0, most=MOST_REFINE),
            "Levels of graded refinement around each singularity; 0 only inserts it as a vertex.",
        ),
    )
    component: int | str | None = field(
        default=None,
        metadata=key(
            Either((Word({"largest": "largest", "all": "all"}), Number(whole=True, least=0))),
            "Which one of a surface in several pieces, which is refused else; 0 is the largest.",
        ),
    )
    repair: bool = field(
        default=False,
        metadata=key(
            Flag(),
            "Also cut the surface apart at non-manifold edges and vertices.",
        ),
    )
    turns: tuple[int, ...] | None = field(
        default=None,
        metadata=key(
            ListOf(Number(whole=True)),
            "Quarter turns of the aligned field over each holonomy condition besides those "
            "nearest to the isotropic field: other layouts, for all methods but the isotropic.",
        ),
    )
    proximal_weight: float = field(
        default=1.0,
        metadata=key(
            Number(above=0),
            "Weight of the proximal term of the alternating method; the paper's is 1.",
        ),
    )
    sizes: Sizes | None = field(
        default=None,
        metadata=key(
            Either(
                (
                    File((".npy", ".txt")),
                    ListOf(ListOf(SIZE, length=2, name="pairs of numbers above 0")),
                    ListOf(SIZE),
                )
            ),
            "Size map that the anisotropic method follows as closely as the singularities allow: "
            "one size, or two (along x and across), for each vertex of the surface given.",
        ),
    )

    def __post_init__(self) -> None:
        check_numbers(self)
        if self.turns is not None:
            turns = whole_numbers("turns", self.turns, (None,), error=CaseError)
            object.__setattr__(self, "turns", tuple(turns.tolist()))
        if self.sizes is not None and not isinstance(self.sizes, str):
            sizes = real_numbers("the size map", self.sizes, error=CaseError).tolist()
            object.__setattr__(self, "sizes", _frozen(sizes))


def _position(given: Any) -> Position:
    """Return a position given in Python as that of a case."""
    x, y, z = real_numbers("position", given, (3,), finite=True, error=CaseError).tolist()
    return x, y, z


def _frozen(rows: Any) -> Any:
    """Return lists as tuples."""
    return tuple(map(_frozen, rows)) if isinstance(rows, list) else rows


def check_method(name: str, where: str) -> str:
    """The method `name` if it is available.

    Raises
    ------
    CaseError
        It is not; the message names the nearest, or lists those that are.
    """
    return known_word(name, METHODS, "method", where)
