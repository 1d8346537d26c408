"""Keeps the validity guide in step with what is under the mouse, beside all other work."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import partial
from typing import NamedTuple

from crossview.session.background import Background
from crossview.session.document import Document
from crossview.session.guide_curves import Guidance, GuideCurve
from crossview.session.live import LiveBase, LiveEdit
from crossview.session.loop import Loop
from crossview.session.state import SessionState
from crossview.session.store import Store
from crossview.view.colors import condition_color
from crossview.view.values import GuideLine


class _Subject(NamedTuple):
    """What guide lines depend on."""

    base: LiveBase
    document: Document
    moving: int
    valence: int
    condition: int | None


class GuideLines:
    """Asks for guide lines when their subject changes; the latest request wins.

    The lines do not depend on where the subject is dragged, so a drag asks once.

    Parameters
    ----------
    store : Store
    loop : Loop
        The thread that answers come on.
    """

    def __init__(self, store: Store, loop: Loop) -> None:
        self._store = store
        self._background = Background(loop)
        self._subject: _Subject | None = None
        store.observers.append(self._follow)

    @property
    def busy(self) -> bool:
        """Whether an answer is still awaited."""
        return self._background.busy

    def close(self) -> None:
        """End the background thread."""
        self._background.close()

    def _follow(self, _: SessionState, state: SessionState) -> None:
        """Bring the lines in line with the state."""
        subject = _subject(state)
        if subject == self._subject:
            return
        self._subject = subject
        if subject is None:
            self._background.forget()
            self._store.update(replace(self._store.state, guide=()))
            return
        guidance = _guidance(state, subject)
        job = partial(guidance.curves, math.radians(state.tolerance), subject.condition)
        self._background.submit(job, self._show, lambda error: self._store.fail(error, "guide"))

    def _show(self, curves: tuple[GuideCurve, ...]) -> None:
        lines = (GuideLine(c.ends, condition_color(c.condition), c.strong) for c in curves)
        self._store.update(replace(self._store.state, guide=tuple(lines)))


def _subject(state: SessionState) -> _Subject | None:
    """Return what the lines are to be of, if there are to be any."""
    document, base, budget = state.document, state.base, state.budget
    wanted = state.layers["guide"].visible and state.moving is None
    if document is None or base is None or budget is None or not wanted:
        return None
    moving = _moving(state)
    if moving is None or not budget.satisfied or not base.solver.holonomy.conditions:
        return None
    if state.trial is not None and not state.trial.drag:
        valence = state.trial.singularities[moving].valence
    else:
        valence = document.singularities[moving].valence
    return _Subject(base, document, moving, valence, state.focus.followed)


def _moving(state: SessionState) -> int | None:
    """Return the number of what is dragged, previewed or hovered; of a row's, what is selected."""
    if state.trial is not None:
        return None if state.trial.edit is None else state.trial.index
    focus = state.focus
    row = focus.hovered is None and focus.condition is not None
    under = focus.selected if row else focus.hovered
    if under is None or state.document is None or state.document.singularities[under].locked:
        return None
    return under


def _guidance(state: SessionState, subject: _Subject) -> Guidance:
    trial = state.trial
    if trial is not None and trial.edit is not None and not trial.drag:
        return Guidance(trial.edit, subject.moving, placed=False)
    return Guidance(LiveEdit.start(subject.document, subject.base), subject.moving)
