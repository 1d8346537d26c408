"""What an action is, and the QActions made from a table of them."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from PySide6.QtGui import QAction, QIcon, QKeySequence
from PySide6.QtWidgets import QWidget

from crossview.gui.icons import put_icon, valence_icon
from crossview.gui.window_verbs import WindowVerbs
from crossview.session.state import SessionState


def _always(_: SessionState) -> bool:
    return True


@dataclass(frozen=True)
class ActionSpec:
    """One verb.

    Parameters
    ----------
    name : str
        Stable identifier.
    text : str
        As in the menu.
    menu : str
        Title of the menu it is in.
    run : callable
        Does it.
    keys : tuple of str
        Shortcuts, the first shown.
    icon : str
        A name of resources/icons, or "valence:3", "valence:n".
    tip : str
        One sentence for the tooltip and the palette.
    enabled : callable
        Whether it makes sense in a state.
    checked : callable or None
        Whether it is on, for those that are.
    separated : bool
        A line comes before it in its menu.
    submenu : str
        Title of the submenu it is in, if any.
    """

    name: str
    text: str
    menu: str
    run: Callable[[WindowVerbs], object]
    keys: tuple[str, ...] = ()
    icon: str = ""
    tip: str = ""
    enabled: Callable[[SessionState], bool] = _always
    checked: Callable[[SessionState], bool] | None = None
    separated: bool = False
    submenu: str = ""


class Actions:
    """The QActions of a window, kept in step with its state.

    Parameters
    ----------
    table : iterable of ActionSpec
    verbs : WindowVerbs
        What they call.
    parent : QWidget
        Where their shortcuts are heard.
    """

    def __init__(self, table: Iterable[ActionSpec], verbs: WindowVerbs, parent: QWidget) -> None:
        self._verbs = verbs
        self.specs = {spec.name: spec for spec in table}
        self.by_name = {name: self._make(spec, parent) for name, spec in self.specs.items()}

    def show(self, state: SessionState) -> None:
        """Enable, check and name the actions for `state`."""
        for name, spec in self.specs.items():
            action = self.by_name[name]
            action.setEnabled(spec.enabled(state))
            if spec.checked is not None:
                action.setChecked(spec.checked(state))
        self.by_name["undo"].setText(_named("Undo", state.undo_name))
        self.by_name["redo"].setText(_named("Redo", state.redo_name))

    def _make(self, spec: ActionSpec, parent: QWidget) -> QAction:
        action = QAction(spec.text, parent)
        action.setObjectName(spec.name)
        action.setShortcuts([QKeySequence(key) for key in spec.keys])
        action.setCheckable(spec.checked is not None)
        keys = f" ({spec.keys[0]})" if spec.keys else ""
        action.setToolTip(f"{spec.text.rstrip('…')}{keys}\n{spec.tip}".rstrip())
        if ":" in spec.icon:
            action.setIcon(_valence_disk(spec.icon))
        elif spec.icon:
            put_icon(action, spec.icon)
        # the action's own state follows the window's, never the other way round
        action.triggered.connect(lambda: self._run(spec))
        parent.addAction(action)
        return action

    def _run(self, spec: ActionSpec) -> None:
        spec.run(self._verbs)
        self.show(self._verbs.session.state)


def _valence_disk(name: str) -> QIcon:
    """Return a valence's disk for a name such as "valence:3"."""
    valence = name.partition(":")[2]
    return valence_icon(None, "n") if valence == "n" else valence_icon(int(valence))


def _named(verb: str, step: str | None) -> str:
    return verb if step is None else f"{verb} {step}"
