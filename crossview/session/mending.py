"""Ways to satisfy the index budget, offered as ready commands."""

from __future__ import annotations

from collections.abc import Callable, Generator
from dataclasses import dataclass

from crossview.session.commands import (
    MAX_VALENCE,
    MIN_VALENCE,
    AddSingularities,
    ChangeValence,
    Command,
    RemoveSingularities,
)
from crossview.session.document import Document
from crossview.session.pairing import distribute
from solvers.progress import Progress
from solvers.singularities.budget import Singularity
from solvers.singularities.placing import far_points

MOST_ADDED = 64


@dataclass(frozen=True)
class Mending:
    """One offer.

    Parameters
    ----------
    label : str
        What the button says.
    make : callable
        Returns a generator that yields Progress and returns the Command; placing a singularity
        measures distances over the whole surface and does not belong in the GUI thread.
    """

    label: str
    make: Callable[[], Generator[Progress, None, Command]]


def mendings(document: Document) -> tuple[Mending, ...]:
    """Return what would bring the index sum nearer to the required one, the most likely first."""
    missing = document.budget.missing
    if missing == 0:
        return ()
    valence = 3 if missing > 0 else 5
    offers = [_offer_added(document, valence, 1)]
    if 1 < abs(missing) <= MOST_ADDED:
        offers.append(_offer_added(document, valence, abs(missing)))
    if abs(missing) <= MOST_ADDED:
        offers.append(Mending("Distribute the missing index", lambda: distribute(document)))
    changed = _last_changeable(document, missing)
    return (*offers, changed) if changed is not None else tuple(offers)


def _offer_added(document: Document, valence: int, count: int) -> Mending:
    many = "one" if count == 1 else f"all {count}"
    return Mending(f"Add {many} valence {valence}", lambda: _added(document, valence, count))


def _last_changeable(document: Document, missing: int) -> Mending | None:
    """Offer to change the newest unlocked singularity that alone can take up `missing`."""
    for index in reversed(range(len(document.singularities))):
        singularity = document.singularities[index]
        valence = singularity.valence - missing
        if singularity.locked or not MIN_VALENCE <= valence <= MAX_VALENCE:
            continue
        if valence == 4:  # regular: it is to go
            return _offer(f"Delete #{index + 1}", RemoveSingularities(frozenset({index})))
        return _offer(f"Make #{index + 1} a valence {valence}", ChangeValence(index, valence))
    return None


def _offer(label: str, command: Command) -> Mending:
    return Mending(label, lambda: _ready(command))


def _ready(command: Command) -> Generator[Progress, None, Command]:
    yield Progress("mending", 1.0)
    return command


def _added(document: Document, valence: int, count: int) -> Generator[Progress, None, Command]:
    points = yield from far_points(document.surface, document.singularities, count)
    return AddSingularities(tuple(Singularity(point, valence) for point in points))
