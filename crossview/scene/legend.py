"""Title, valence legend and colour bar: the texts of a figure."""

from __future__ import annotations

import numpy as np
import pyvista as pv

from crossview.scene.overlay import Label, Patches, discs
from crossview.scene.watch import Watch
from crossview.view.colors import THEMES, bytes_of, color_table, valence_color
from crossview.view.geometry import IntArray, Triangles
from crossview.view.scalars import SCALARS, Beyond, bar_texts, shown_scalar
from crossview.view.scene_view import SceneView

MARGIN = 18.0
"""From the edges of the picture, in pixels of the window, as all here. Chosen, as all here."""

TEXT_SIZE, TITLE_SIZE = 13.0, 15.0
"""Of texts, and of the title."""

BAR_WIDTH, BAR_HEIGHT, BAR_COLORS = 14.0, 170.0, 128
"""The colour bar, whose texts stand to the left of it, and its steps of colour."""

BAR_GAP, BAR_TITLE = 7.0, 16.0
"""From the colour bar to its texts, and to its title."""

BAR_ROOM, LEGEND_ROOM = 96.0, 46.0
"""Room that the colour bar and the legend need on the right and at the bottom."""

LETTER = 7.5
"""Width of a letter of the colour bar's title."""

FOOT = MARGIN + 4.0
"""Height of the legend's line and of the colour bar's foot."""

DISC, _FIRST, _STEP = 6.5, 74.0, 46.0
"""Radius of the legend's discs, where the first is, and how far apart they are."""


def bar_room(shown: str) -> float:
    """Return the room, pixels, that the colour bar of a scalar and its title need on the right."""
    return max(BAR_ROOM, 2 * MARGIN + LETTER * len(SCALARS[shown].title))


class TitleLayer:
    """One line at the top left."""

    def __init__(self, plotter: pv.BasePlotter, pixel_ratio: float) -> None:
        self._ratio = pixel_ratio
        self._label = Label(plotter, (0.0, 1.0), TITLE_SIZE * pixel_ratio, "left")
        self._watch = Watch()

    def show(self, view: SceneView, triangles: Triangles | None) -> None:
        """Apply what changed."""
        if self._watch.changed("title", view.title, view.background):
            offset = (MARGIN * self._ratio, -FOOT * self._ratio)
            self._label.show(view.title, offset, THEMES[view.background].text)

    def remove(self) -> None:
        """Take the title off the plotter."""
        self._label.remove()


class ValenceLegendLayer:
    """A disc and a number for each valence present, at the bottom left."""

    def __init__(self, plotter: pv.BasePlotter, pixel_ratio: float) -> None:
        self._plotter = plotter
        self._ratio = pixel_ratio
        self._patches = Patches(plotter, (0.0, 0.0))
        self._labels: list[Label] = []
        self._watch = Watch()

    def show(self, view: SceneView, triangles: Triangles | None) -> None:
        """Apply what changed."""
        shown = view.layer("legend").visible and view.layer("singularities").visible
        valences = sorted({m.valence for m in view.singularities}) if shown else []
        if self._watch.changed("valences", tuple(valences), view.background):
            self._draw(valences, THEMES[view.background].text)

    def remove(self) -> None:
        """Take the legend off the plotter."""
        self._patches.remove()
        for label in self._labels:
            label.remove()

    def _draw(self, valences: list[int], color: str) -> None:
        words, discs_at = legend_layout(valences)
        while len(self._labels) < len(words):
            self._labels.append(Label(self._plotter, (0.0, 0.0), TEXT_SIZE * self._ratio, "left"))
        spare = [("", 0.0)] * (len(self._labels) - len(words))
        for label, (text, x) in zip(self._labels, words + spare, strict=True):
            label.show(text, (x * self._ratio, FOOT * self._ratio), color)
        if not valences:
            self._patches.hide()
            return
        centres = np.array([[x, FOOT] for x in discs_at])
        points, cells = discs(self._ratio * centres, DISC * self._ratio)
        self._patches.show(points, cells, bytes_of([valence_color(n) for n in valences]))


def legend_layout(valences: list[int]) -> tuple[list[tuple[str, float]], list[float]]:
    """Return the words of the legend with where they start, and where its discs are, in pixels."""
    if not valences:
        return [], []
    at = [MARGIN + _FIRST + _STEP * i for i in range(len(valences))]
    words = [(str(n), x + DISC + 7.0) for n, x in zip(valences, at, strict=True)]
    return [("valence", MARGIN), *words], at


class ColorBarLayer:
    """The colours of the scalar shown with their limits, at the bottom right; never moves."""

    def __init__(self, plotter: pv.BasePlotter, pixel_ratio: float) -> None:
        self._ratio = pixel_ratio
        self._patches = Patches(plotter, (1.0, 0.0))
        self._title = Label(plotter, (1.0, 0.0), (TEXT_SIZE + 1.0) * pixel_ratio, "right")
        self._ticks = [
            Label(plotter, (1.0, 0.0), TEXT_SIZE * pixel_ratio, "right") for _ in range(5)
        ]
        self._watch = Watch()

    def show_range(self, view: SceneView, limits: tuple[float, float], beyond: Beyond) -> None:
        """Apply what changed; `limits` are those in use, `beyond` where values are."""
        shown = shown_scalar(view)
        settings = view.layer(shown or "H")
        name = settings.color_map or SCALARS[shown or "H"].color_map
        seen = (shown, name, settings.opacity, limits, beyond, view.background)
        if not self._watch.changed("bar", *seen):
            return
        color = THEMES[view.background].text
        texts = bar_texts(shown, limits, beyond) if shown else [""] * 5
        self._title.show(
            SCALARS[shown].title if shown else "", self._at(1.0, BAR_HEIGHT + BAR_TITLE), color
        )
        for i, (label, text) in enumerate(zip(self._ticks, texts, strict=True)):
            x, y = self._at(0.0, BAR_HEIGHT * i / 4.0)
            label.show(text, (x - BAR_GAP * self._ratio, y), color)
        if shown:
            self._bar(color_table(name, settings.opacity, BAR_COLORS)[:, :3])
        else:
            self._patches.hide()

    def remove(self) -> None:
        """Take the colour bar off the plotter."""
        self._patches.remove()
        for label in (self._title, *self._ticks):
            label.remove()

    def _at(self, across: float, up: float) -> tuple[float, float]:
        """Pixels from the corner: `across` in widths of the bar, `up` from its foot."""
        x = -MARGIN - BAR_WIDTH * (1.0 - across)
        return x * self._ratio, (FOOT + up) * self._ratio

    def _bar(self, colors: IntArray) -> None:
        n = len(colors)
        heights = np.linspace(0.0, BAR_HEIGHT, n + 1)
        left = np.array([self._at(0.0, y) for y in heights])
        right = np.array([self._at(1.0, y) for y in heights])
        i = np.arange(n)
        cells = np.stack([i, n + 1 + i, n + 2 + i, i + 1], axis=1)
        self._patches.show(np.vstack([left, right]), cells, colors)
