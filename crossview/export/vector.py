"""Figures as SVG or PDF: the shaded surface as one image, all lines, discs and texts as vectors.

They are drawn through the same camera and with the same layout as the picture in pixels; what
the surface hides is left out, told by its depth in each pixel.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_pdf import FigureCanvasPdf
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure

from crossview.export.raster import Seen, picture, pixel_ratio, seen
from crossview.export.sheet import Sheet
from crossview.export.vector_curves import draw_in_space
from crossview.scene import LAYERS, Camera, SceneView, axes, legend
from crossview.view.colors import (
    THEMES,
    color_table,
    valence_color,
)
from crossview.view.geometry import Triangles
from crossview.view.scalars import SCALARS, bar_texts, shown_scalar

_DPI = 200.0
"""Pixels of the layout per inch on paper. Chosen: 1600 x 1200 is 8 by 6 inches."""

_SETTINGS = {
    "svg.fonttype": "none",
    "svg.hashsalt": "crossview",
    "pdf.fonttype": 42,
    "font.family": ["DejaVu Sans"],
}
"""Of matplotlib: texts stay texts, and the same figure gives the same file."""


def save_vector(
    views: Sequence[SceneView],
    path: Path,
    size: tuple[int, int],
    scale: float,
    camera: str | Camera,
    dpi: float | None = None,
    about: str = "",
) -> None:
    """Draw views side by side to an SVG or PDF file, by its suffix.

    Parameters
    ----------
    views : sequence of SceneView
    path : Path
    size, scale, camera, dpi, about
        As of `figures.render_view`; the size is that of each.
    """
    per_inch = _DPI if dpi is None else dpi / scale
    across = len(views) * size[0] / per_inch
    with matplotlib.rc_context(_SETTINGS):
        figure = Figure(figsize=(across, size[1] / per_inch), dpi=per_inch * scale)
        figure.patch.set_alpha(0.0)
        for number, view in enumerate(views):
            paper = figure.add_axes((number / len(views), 0.0, 1.0 / len(views), 1.0))
            _draw(view, paper, size, scale, camera, per_inch)
        if path.suffix.lower() == ".svg":
            said = {"Date": None, "Description": about or None}
            FigureCanvasSVG(figure).print_svg(path, metadata=said)
        else:
            said = {"CreationDate": None, "Keywords": about or None}
            FigureCanvasPdf(figure).print_pdf(path, metadata=said)


def _draw(
    view: SceneView,
    paper: Axes,
    size: tuple[int, int],
    scale: float,
    camera: str | Camera,
    per_inch: float,
) -> None:
    """Draw a view on its part of the paper."""
    bare = _only_surface(view)
    image = picture(bare, size, scale, camera, texts=False)
    eye = seen(bare, size, camera)
    paper.set_axis_off()
    paper.imshow(image, extent=(0, size[0], 0, size[1]), interpolation="none", aspect="auto")
    paper.set(xlim=(0, size[0]), ylim=(0, size[1]))
    sheet = Sheet(paper, eye, pixel_ratio(size), per_inch)
    if view.points is not None and view.faces is not None:
        triangles = Triangles(view.points, view.faces)
        draw_in_space(sheet, view, triangles)
    _draw_axes(sheet, view, eye)
    _write_legend(sheet, view, size[1] / pixel_ratio(size))
    _draw_bar(sheet, view, size[0] / pixel_ratio(size), eye)


def _only_surface(view: SceneView) -> SceneView:
    """Return the view without what is drawn as vectors; the room for the texts is kept."""
    layers = {
        kind.name: view.layer(kind.name)
        if kind.name in ("surface", *SCALARS)
        else replace(view.layer(kind.name), visible=False)
        for kind in LAYERS
    }
    for name in ("quads", "layout"):
        layers[name] = replace(layers[name], visible=view.layer(name).visible, edges=False)
    quads = None if view.quads is None else replace(view.quads, irregular=np.empty((0, 3)))
    shown = MappingProxyType(layers)
    return replace(view, layers=shown, loop=None, preview=None, quads=quads)


def _draw_axes(sheet: Sheet, view: SceneView, eye: Seen) -> None:
    if view.layer("axes").visible:
        faint = THEMES[view.background].faint
        corner = np.array(eye.size) / pixel_ratio(eye.size)
        lines, names = axes.axes_layout(eye.turn)
        sheet.stroke(corner + lines, faint, axes.LINE_WIDTH)
        for name, x, y in names:
            at = (float(corner[0] + x), float(corner[1] + y))
            sheet.word(name, at, faint, "center", axes.TEXT_SIZE)


def _write_legend(sheet: Sheet, view: SceneView, top: float) -> None:
    ink = THEMES[view.background].text
    if view.title:
        at = (legend.MARGIN, top - legend.FOOT)
        sheet.word(view.title, at, ink, "left", legend.TITLE_SIZE)
    if view.layer("legend").visible and view.layer("singularities").visible:
        valences = sorted({m.valence for m in view.singularities})
        words, places = legend.legend_layout(valences)
        for word, x in words:
            sheet.word(word, (x, legend.FOOT), ink, "left", legend.TEXT_SIZE)
        for valence, x in zip(valences, places, strict=True):
            sheet.dot((x, legend.FOOT), legend.DISC, valence_color(valence))


def _draw_bar(sheet: Sheet, view: SceneView, width: float, eye: Seen) -> None:
    shown = shown_scalar(view)
    if not shown:
        return
    settings, ink = view.layer(shown), THEMES[view.background].text
    right = width - legend.MARGIN
    left = right - legend.BAR_WIDTH
    levels = legend.FOOT + np.linspace(0.0, legend.BAR_HEIGHT, legend.BAR_COLORS + 1)
    name = settings.color_map or SCALARS[shown].color_map
    colors = color_table(name, settings.opacity, legend.BAR_COLORS) / 255.0
    sheet.column(left, right, levels, colors)
    words = bar_texts(shown, eye.limits, eye.beyond)
    for word, y in zip(words, np.linspace(levels[0], levels[-1], len(words)), strict=True):
        sheet.word(word, (left - legend.BAR_GAP, float(y)), ink, "right", legend.TEXT_SIZE)
    above = (right, float(levels[-1]) + legend.BAR_TITLE)
    sheet.word(SCALARS[shown].title, above, ink, "right", legend.TEXT_SIZE + 1.0)
