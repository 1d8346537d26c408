"""Verbs of what is in hand and pointed at: tools, selection, what is under the mouse."""

from __future__ import annotations

from dataclasses import replace

from crossview.session.hand import AddTool, Focus, SelectTool
from crossview.session.store import Store


class Pointer:
    """Selects and takes tools; changes nothing of the document.

    Parameters
    ----------
    store : Store
    """

    def __init__(self, store: Store) -> None:
        self._store = store

    def select(self, index: int | None, both: bool = False) -> None:
        """Select singularity `index`; with `both` the one selected before stays selected too."""
        self._to(self._focus.on(index, both=both))

    def select_all(self) -> None:
        """Select every singularity, the last one foremost."""
        count = len(self._store.state.singularities)
        if count:
            self._to(replace(self._focus, selected=count - 1, others=frozenset(range(count - 1))))

    def select_also(self, indices: tuple[int, ...]) -> None:
        """Select singularities besides those that are."""
        chosen = sorted({*self._focus.all, *indices})
        if chosen:
            self._to(replace(self._focus, selected=chosen[-1], others=frozenset(chosen[:-1])))

    def choose(self, index: int) -> None:
        """Select singularity `index` in place of the one selected; a second one stays."""
        self._store.update(self._store.state.selecting(index))

    def hover(self, index: int | None) -> None:
        """Tell that singularity `index` is under the mouse."""
        self._to(replace(self._focus, hovered=index))

    def point_out(self, condition: int | None) -> None:
        """Point out the loop of a holonomy condition."""
        self._to(replace(self._focus, condition=condition))

    def toggle_pin(self, condition: int) -> None:
        """Let the guide keep to a holonomy condition, or no longer."""
        pinned = None if self._focus.pinned == condition else condition
        self._to(replace(self._focus, pinned=pinned))

    def take_tool(self, valence: int) -> None:
        """Take the tool that adds a valence, or put it back when it is in hand."""
        held = self._store.state.added_valence == valence
        self._store.update(self._store.state.tool_taken(SelectTool() if held else AddTool(valence)))

    def choose_valence(self, valence: int) -> None:
        """Let the tool "any valence" carry another; in hand, it does so at once."""
        self._store.update(self._store.state.any_valence_chosen(valence))

    def put_tool_back(self) -> None:
        """Take the select tool."""
        self._store.update(self._store.state.tool_taken(SelectTool()))

    @property
    def _focus(self) -> Focus:
        return self._store.state.focus

    def _to(self, focus: Focus) -> None:
        self._store.update(self._store.state.focused(focus))
