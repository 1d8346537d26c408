"""A sheet of paper laid over a picture: lines, discs and words in its pixels, as vectors."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.patches import Circle

from crossview.export.raster import Seen
from crossview.view.geometry import FloatArray

_STEPS = 13
"""Points of a line at which it may be cut where it goes behind the surface. Chosen."""

Point = tuple[float, float]


class Sheet:
    """Draws on matplotlib axes whose unit is the picture's pixel.

    Parameters
    ----------
    axes : Axes
    eye : Seen
        Where things in space are, and what hides them.
    ratio : float
        Pixels of the picture per pixel of the window, for widths and sizes.
    dpi : float
        Pixels of the picture per inch.
    """

    def __init__(self, axes: Axes, eye: Seen, ratio: float, dpi: float) -> None:
        self._axes, self._eye = axes, eye
        self._ratio, self._points = ratio, ratio * 72.0 / dpi
        # Later things lie on earlier ones.
        self._order = 1.0

    def lines(
        self,
        segments: FloatArray,
        color: str,
        width: float,
        towards: float,
        opacity: float = 1.0,
        *,
        round_ends: bool = False,
    ) -> None:
        """Draw what is not hidden of segments (k, 2, 3) in space, `towards` the eye."""
        along = np.linspace(0.0, 1.0, _STEPS)[:, None]
        points = segments[:, :1] * (1.0 - along) + segments[:, 1:] * along
        at = self._eye.project(points)
        shown = self._eye.visible(at, towards)
        pieces = shown[:, :-1] & shown[:, 1:]
        # Runs of pieces: where one begins and where it ends.
        edge = np.diff(np.pad(pieces, ((0, 0), (1, 1))).astype(int), axis=1)
        rows, first = np.nonzero(edge == 1)
        last = np.nonzero(edge == -1)[1]
        ends = np.stack([at[rows, first, :2], at[rows, last, :2]], axis=1)
        self._axes.add_collection(
            LineCollection(
                list(ends),
                colors=color,
                linewidths=width * self._points,
                alpha=None if opacity == 1.0 else opacity,
                capstyle="round" if round_ends else "butt",
                zorder=self._next(),
            ),
            autolim=False,
        )

    def discs(
        self,
        centres: FloatArray,
        radius: float,
        towards: float,
        colors: Sequence[Sequence[str]],
        parts: Sequence[float],
    ) -> None:
        """Draw discs in space that face the eye, each of several parts from the rim inwards.

        Parameters
        ----------
        centres : (k, 3) float
        radius : float
            In space.
        towards : float
        colors : k sequences of str
            For each disc a colour per part.
        parts : sequence of float
            Radius of each part as a share of the disc's.
        """
        at = self._eye.project(centres)
        sides = self._eye.project(centres[:, None] + radius * np.eye(3))[..., :2] - at[:, None, :2]
        pixels = np.linalg.norm(sides, axis=(1, 2)) / np.sqrt(2.0)
        shown = self._eye.visible(at, towards)
        for i in np.argsort(-at[:, 2]):
            if shown[i]:
                for part, color in zip(parts, colors[i], strict=True):
                    self._disc((at[i, 0], at[i, 1]), part * pixels[i], color)

    def signs(
        self,
        places: FloatArray,
        diameter: float,
        towards: float,
        strokes: Sequence[Sequence[float]],
        paints: tuple[str, str],
        rim: float,
    ) -> None:
        """Draw signs, of one size at every distance, at places in space that are not hidden.

        Parameters
        ----------
        places : (k, 3) float
        diameter : float
            In pixels of the window.
        towards : float
        strokes : sequence of (left, low, right, high)
            Boxes of its letter, in diameters from its centre.
        paints : (str, str)
            Ink and paper.
        rim : float
            Width of the rim, in diameters.
        """
        at, size = self._eye.project(places), diameter * self._ratio
        boxes = np.array(strokes)[:, [[0, 1], [2, 1], [2, 3], [0, 3]]]
        shown = self._eye.visible(at, towards)
        for place in at[np.argsort(-at[:, 2])][shown[np.argsort(-at[:, 2])], :2]:
            for paint, share in zip(paints, (1.0, 1.0 - 2.0 * rim), strict=True):
                self._disc((place[0], place[1]), 0.5 * share * size, paint)
            letter = PolyCollection(
                list(place + size * boxes), facecolors=paints[0], lw=0, zorder=self._next()
            )
            self._axes.add_collection(letter, autolim=False)

    def stroke(self, ends: FloatArray, color: str, width: float) -> None:
        """Draw lines (k, 2, 2) on the sheet, in pixels of the window from the bottom left."""
        self._axes.add_collection(
            LineCollection(
                list(ends * self._ratio),
                colors=color,
                linewidths=width * self._points,
                zorder=self._next(),
            ),
            autolim=False,
        )

    def dot(self, at: Point, radius: float, color: str) -> None:
        """Draw a disc on the sheet, in pixels of the window from the bottom left."""
        x, y = at
        self._disc((x * self._ratio, y * self._ratio), radius * self._ratio, color)

    def word(self, text: str, at: Point, color: str, align: str, size: float) -> None:
        """Write one line on the sheet, in pixels of the window from the bottom left."""
        x, y = at
        self._axes.text(
            x * self._ratio,
            y * self._ratio,
            text,
            color=color,
            fontsize=size * self._points,
            horizontalalignment=align,
            verticalalignment="center_baseline",
            parse_math=False,
            zorder=self._next(),
        )

    def column(self, left: float, right: float, levels: FloatArray, colors: FloatArray) -> None:
        """Draw boxes upon each other between levels (n + 1,), with rows of colours (n, 4)."""
        low, high = levels[:-1], levels[1:]
        box = np.stack(
            [
                np.stack([np.full(len(low), x), y], axis=1)
                for x, y in ((left, low), (right, low), (right, high), (left, high))
            ],
            axis=1,
        )
        # Edges of the same colour, or hairs of the background show between the boxes.
        self._axes.add_collection(
            PolyCollection(
                list(box * self._ratio),
                facecolors=colors,
                edgecolors=colors,
                linewidths=0.2,
                zorder=self._next(),
            ),
            autolim=False,
        )

    def _disc(self, centre: Point, radius: float, color: str) -> None:
        self._axes.add_patch(Circle(centre, radius, color=color, lw=0, zorder=self._next()))

    def _next(self) -> float:
        self._order += 0.001
        return self._order
