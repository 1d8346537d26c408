"""What may be done about an error or what is impossible, carried out as commands."""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import dataclass

from crossview.session.commands import (
    MAX_VALENCE,
    AddSingularities,
    AddTurns,
    ChangeValence,
    ChooseMethod,
    Command,
    RemoveSingularities,
    ReplaceSingularities,
    SetCorners,
)
from crossview.session.document import Document
from crossview.session.rearrangements import (
    add_pair_somewhere,
    distribute,
    merge,
    move_inside,
    split_one,
)
from solvers.progress import Progress
from solvers.remedies import Remedy, UseMethod
from solvers.singularities import (
    AddMissing,
    AddPair,
    ChangeCorners,
    ChangeOne,
    ChangeTurns,
    MergeTwo,
    MoveInside,
    RemoveOne,
    Singularity,
    SplitOne,
    far_points,
)
from solvers.validity import MOST_PLACED, PlaceAnew


@dataclass(frozen=True)
class DistributeMissing(Remedy):
    """Add what the index budget lacks, where it evens out the sizes most."""


def mendings(document: Document) -> tuple[Remedy, ...]:
    """Return what would meet the index budget, then what makes quads possible, best first."""
    budget = document.budget
    missing = abs(budget.missing)
    if missing == 0:
        return document.existence.remedies
    found = [remedy for remedy in budget.remedies if _usual(remedy)]
    if missing > 1:
        found.insert(0, AddMissing.of(3 if budget.missing > 0 else 5, 1))
    if missing <= MOST_PLACED:
        found.append(DistributeMissing("distribute the missing index"))
    return tuple(found)


def _usual(remedy: Remedy) -> bool:
    """Whether singularities are as many, and of such valences, as the window offers."""
    match remedy:
        case AddMissing(valence=valence, count=count):
            return valence <= MAX_VALENCE and count <= MOST_PLACED
        case ChangeOne(valence=valence):
            return valence <= MAX_VALENCE
        case _:
            return True


def mend(document: Document, remedy: Remedy) -> Generator[Progress, None, Command]:
    """Make a command of a remedy that changes the document.

    Placing singularities measures distances over the whole surface, and does not belong in the
    thread of the window.

    Parameters
    ----------
    document : Document
    remedy : Remedy
        One of `mendings`, or of the errors of a document.
    """
    yield Progress("mending", 0.0)
    match remedy:
        case AddMissing(valence=valence, count=count):
            points = yield from far_points(document.surface, document.singularities, count)
            return AddSingularities(tuple(Singularity(point, valence) for point in points))
        case DistributeMissing():
            return (yield from distribute(document))
        case AddPair():
            return (yield from add_pair_somewhere(document))
        case MergeTwo(one=one, other=other):
            return merge(document, one, other)
        case SplitOne(number=number):
            return split_one(document, number)
        case MoveInside(number=number):
            return move_inside(document, number)
        case _:
            return _at_once(remedy)


def _at_once(remedy: Remedy) -> Command:
    """Return the command of a remedy that measures nothing on the surface."""
    match remedy:
        case ChangeOne(number=number, valence=valence):
            return ChangeValence(number, valence)
        case RemoveOne(number=number):
            return RemoveSingularities(frozenset({number}))
        case ChangeCorners(corners=corners):
            return SetCorners(corners)
        case ChangeTurns(by=by):
            return AddTurns(by)
        case PlaceAnew(singularities=singularities, step=step):
            return ReplaceSingularities(singularities, f"make valid, {step}")
        case UseMethod(method=method):
            return ChooseMethod(method)
        case _:
            raise TypeError(f"{remedy} changes no document")
