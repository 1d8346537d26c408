"""Verbs of how things are drawn."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from crossview.session.store import Store
from crossview.session.verbs.solving import Solving
from crossview.view.scalars import SCALARS, SURFACE_SCALARS
from crossview.view.scene_view import LayerSettings, default_layers
from crossview.view.values import FloatArray, Plane

CLIP_STEP = 0.02
"""How far one step moves the plane that clips, in diagonals of the surface. Chosen."""


class Looks:
    """Shows and hides; what a layer newly needs is made in the background.

    Parameters
    ----------
    store : Store
    solving : Solving
    """

    def __init__(self, store: Store, solving: Solving) -> None:
        self._store = store
        self._solving = solving

    def set_layer(self, name: str, settings: LayerSettings) -> None:
        """Draw one layer otherwise."""
        state = self._store.state.with_layer(name, settings)
        self._store.update(state if state.layers["layout"].visible else state.unsaid("layout"))
        self._solving.pursue()

    def restore(self, layers: Mapping[str, LayerSettings]) -> None:
        """Draw these layers as given, all others as at first."""
        state = replace(self._store.state, layers={**default_layers(), **layers}, uncompared=None)
        self._store.update(state)
        self._solving.pursue()

    def toggle_layer(self, name: str) -> None:
        """Show or hide a layer."""
        layer = self._store.state.layers[name]
        self.set_layer(name, replace(layer, visible=not layer.visible))

    def color_by(self, name: str) -> None:
        """Colour the surface by one of its scalars; empty: by none."""
        state = self._store.state
        for scalar in SURFACE_SCALARS:
            state = state.with_layer_shown(scalar, scalar == name)
        self._store.update(state)
        self._solving.pursue()

    def compare(self) -> None:
        """Show the error density of the start, or of the result again, on the same range."""
        state = self._store.state
        before = state.uncompared
        if before is None:
            seen = frozenset(name for name in SURFACE_SCALARS if state.layers[name].visible)
            self._store.update(replace(state.with_layer_shown("error"), uncompared=seen))
            return
        for name in SURFACE_SCALARS:
            state = state.with_layer_shown(name, name in before)
        self._store.update(replace(state, uncompared=None))

    def shade(self, shaded: bool) -> None:
        """Light the colours of all scalars, or show them as the bar does."""
        layers = self._store.state.layers
        lit = {name: replace(layers[name], shaded=shaded) for name in SCALARS}
        self._store.update(replace(self._store.state, layers={**layers, **lit}))

    def set_dark(self, dark: bool) -> None:
        """Draw on a dark background, or on white."""
        self._store.update(replace(self._store.state, dark=dark))

    def toggle_dark(self) -> None:
        """Draw on a dark background, or on white again."""
        self.set_dark(not self._store.state.dark)

    def toggle_clip(self, towards: FloatArray) -> None:
        """Cut away the half that a direction (3,) points to, or show all again."""
        state = self._store.state
        if state.document is None:
            return
        low, high = (end(state.document.surface.vertices, axis=0) for end in (np.min, np.max))
        place, normal = (low + high) / 2, towards / np.linalg.norm(towards)
        plane = Plane(tuple(place.tolist()), tuple(normal.tolist()))
        self._store.update(replace(state, clip=plane if state.clip is None else None))

    def move_clip(self, steps: int) -> None:
        """Cut away less, or by negative steps more."""
        state = self._store.state
        if state.document is not None and state.clip is not None:
            by = steps * CLIP_STEP * state.document.surface.diagonal
            self._store.update(replace(state, clip=state.clip.moved(by)))

    def show_poor(self, shown: bool) -> None:
        """Point out the poor triangles."""
        self._store.update(replace(self._store.state, poor=shown))
