"""Jobs that place singularities anew: towards validity, or where they appear by themselves."""

from __future__ import annotations

import time
from collections.abc import Generator
from dataclasses import dataclass, replace
from functools import partial
from typing import TypeVar

from crossview.session.commands import Command, ReplaceSingularities
from crossview.session.document import Document
from crossview.session.live import LiveBase, with_directions
from crossview.session.method_solver import DRAWN_EVERY
from crossview.workflow import configurations
from solvers.errors import CrossviewError
from solvers.fields import NATURAL_ALIGNMENTS, CrossesStep, CrossField
from solvers.layouts import Snapped
from solvers.progress import Progress, relayed
from solvers.singularities import Singularity
from solvers.surface import FloatArray
from solvers.validity import Improved, Moved

T = TypeVar("T")

TOLD_EVERY = 0.05
"""Least time between two reports of a computation with many short steps, seconds."""

NATURAL_LABELS = {
    "mbo": "MBO",
    "ginzburg-landau": "Ginzburg-Landau",
    "globally-optimal": "Globally optimal",
}
"""What the ways to natural singularities are called."""


@dataclass(frozen=True, eq=False)
class Waypoint(Progress):
    """A step of the singularities' way, ready to be drawn.

    Parameters
    ----------
    stage, fraction
        As in `Progress`.
    singularities : tuple of Singularity
        Where they are, on the document's surface.
    defects : (c,) float array or None
        Their holonomy defects, radians; None before there are any singularities.
    field : CrossField or None
        Theirs, on the kept factor, or that from which they will come, on the document's surface;
        None where there is none.
    """

    singularities: tuple[Singularity, ...]
    defects: FloatArray | None
    field: CrossField | None


def move_to_validity(
    document: Document, base: LiveBase | None
) -> Generator[Progress, None, Command]:
    """Move the unlocked singularities until the document is valid; yields each `Waypoint`.

    Raises
    ------
    SingularityError
        As `solvers.validity.make_valid`.
    """
    _, moved = yield from relayed(
        configurations.make_valid(document.problem), partial(_waypoint, base)
    )
    aimed = f", aimed at {moved.aim}" if moved.aim else ""
    return ReplaceSingularities(
        moved.singularities, f"make valid{aimed}", connections=document.connections
    )


def improve_sizes(
    document: Document, base: LiveBase | None
) -> Generator[Progress, None, tuple[Command, Improved]]:
    """Move the unlocked singularities to where sizes are most even; yields each `Waypoint`.

    Returns
    -------
    Command
    Improved
        What it gains.

    Raises
    ------
    SingularityError
        As `solvers.validity.improve`.
    """
    _, end = yield from relayed(configurations.improve(document.problem), partial(_waypoint, base))
    return improved_to(document, end.singularities), end


def improved_to(document: Document, singularities: tuple[Singularity, ...]) -> Command:
    """Return the step to more even sizes, at its end or where it was stopped."""
    return ReplaceSingularities(singularities, "improve sizes", connections=document.connections)


def snap_separatrices(
    document: Document, base: LiveBase | None
) -> Generator[Progress, None, tuple[Command, Snapped]]:
    """Move the unlocked singularities until separatrices meet others; yields each `Waypoint`.

    Returns
    -------
    Command
    Snapped
        Which singularities are joined.

    Raises
    ------
    SingularityError
        As `solvers.layouts.snap`.
    """
    made, end = yield from relayed(configurations.snap(document.problem), partial(_waypoint, base))
    command = ReplaceSingularities(
        end.singularities, "snap separatrices", connections=made.connections
    )
    return command, end


def connect(
    document: Document, base: LiveBase | None, pair: tuple[int, int]
) -> Generator[Progress, None, tuple[Command, Snapped]]:
    """Move the unlocked singularities until a separatrix joins two; yields each `Waypoint`.

    Returns
    -------
    Command
    Snapped
        Which singularities are joined, these among them.

    Raises
    ------
    SingularityError
        As `solvers.layouts.join`.
    """
    wanted = replace(document.problem, connections=(*document.connections, pair))
    made, end = yield from relayed(configurations.connect(wanted), partial(_waypoint, base))
    one, other = sorted(pair)
    name = f"connect singularities {one + 1} and {other + 1}"
    return ReplaceSingularities(end.singularities, name, connections=made.connections), end


def merge_to_fewer(
    document: Document, base: LiveBase | None, most: int
) -> Generator[Progress, None, Command]:
    """Merge unlocked singularities until `most` are left, valid; yields each `Waypoint`.

    Raises
    ------
    SingularityError
        As `solvers.validity.simplify`.
    """
    _, end = yield from relayed(
        configurations.simplify(document.problem, most), partial(_waypoint, base)
    )
    return ReplaceSingularities(end.singularities, f"simplify to {most}")


def place_natural(
    document: Document,
    method: str,
    alignment: str = NATURAL_ALIGNMENTS[0],
    *,
    fewest: bool = False,
) -> Generator[Progress, None, Command]:
    """Find the singularities of a smooth cross-field, with automatic corners as it has.

    Yields a `Waypoint` without singularities for each field on its way.

    Parameters
    ----------
    document : Document
    method, alignment, fewest
        As of `natural_singularities`.
    """
    computation = configurations.natural(
        document.problem, method, alignment=alignment, fewest=fewest
    )
    drawn = -DRAWN_EVERY

    def show(step: Progress) -> Progress:
        nonlocal drawn
        if not isinstance(step, CrossesStep) or time.monotonic() - drawn < DRAWN_EVERY:
            return step
        drawn = time.monotonic()
        field = with_directions(step.field)
        return Waypoint(step.stage, step.fraction, (), None, field)

    found = yield from relayed(_paced(computation), show)
    how = f"{NATURAL_LABELS[method]}, fewest" if fewest else NATURAL_LABELS[method]
    name = f"natural singularities ({how})"
    return ReplaceSingularities(tuple(found.singularities), name, automatic_corners=True)


def _waypoint(base: LiveBase | None, step: Progress) -> Progress:
    if not isinstance(step, Moved):
        return step
    field = _field(base, step.singularities)
    return Waypoint(step.stage, step.fraction, step.singularities, step.defects, field)


def _field(base: LiveBase | None, singularities: tuple[Singularity, ...]) -> CrossField | None:
    if base is None:
        return None
    placed = tuple(replace(s, point=base.refinement.locate(s.point)) for s in singularities)
    try:
        return with_directions(base.solver.solve(placed))
    except CrossviewError:  # on their way they may be where this surface has no field
        return None


def _paced(computation: Generator[Progress, None, T]) -> Generator[Progress, None, T]:
    told = -TOLD_EVERY

    def show(step: Progress) -> Progress | None:
        nonlocal told
        if time.monotonic() - told < TOLD_EVERY:
            return None
        told = time.monotonic()
        return step

    return relayed(computation, show)
