"""Figures as SVG or PDF: the shaded surface as one image, all lines, discs and texts as vectors.

They are drawn through the same camera and with the same layout as the picture in pixels; what
the surface hides is left out, told by its depth in each pixel.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import MappingProxyType

import matplotlib
import numpy as np
from matplotlib.backends.backend_pdf import FigureCanvasPdf
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure

from crossview.export.raster import Seen, picture, pixel_ratio, seen
from crossview.export.sheet import Sheet
from crossview.export.vector_meshes import draw_marks, draw_quads, draw_separatrices
from crossview.scene import LAYERS, Camera, SceneView, axes, legend
from crossview.scene.crosses import CrossGlyphs
from crossview.scene.curves import CUT_DASH, CUT_GAP
from crossview.scene.singularities import DISC_PAINTS, DISC_PARTS, marker_radius
from crossview.view.colors import (
    CROSS,
    CUT,
    CUT_HALO,
    FEATURE,
    LOOP,
    PROBLEM,
    THEMES,
    color_table,
    valence_color,
)
from crossview.view.geometry import Triangles, dashes
from crossview.view.scalars import SCALARS, bar_texts, shown_scalar
from crossview.view.style import TOWARDS, WIDTH

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
    view: SceneView,
    path: Path,
    size: tuple[int, int],
    scale: float,
    camera: str | Camera,
    dpi: float | None = None,
    about: str = "",
) -> None:
    """Draw a view to an SVG or PDF file, by its suffix; parameters as of `figures.render_view`."""
    bare = _only_surface(view)
    image = picture(bare, size, scale, camera, texts=False)
    eye = seen(bare, size, camera)
    per_inch = _DPI if dpi is None else dpi / scale
    with matplotlib.rc_context(_SETTINGS):
        figure = Figure(figsize=(size[0] / per_inch, size[1] / per_inch), dpi=per_inch * scale)
        figure.patch.set_alpha(0.0)
        paper = figure.add_axes((0.0, 0.0, 1.0, 1.0))
        paper.set_axis_off()
        paper.imshow(image, extent=(0, size[0], 0, size[1]), interpolation="none", aspect="auto")
        paper.set(xlim=(0, size[0]), ylim=(0, size[1]))
        sheet = Sheet(paper, eye, pixel_ratio(size), per_inch)
        if view.points is not None and view.faces is not None:
            triangles = Triangles(view.points, view.faces)
            draw_quads(sheet, view, triangles)
            _draw_crosses(sheet, view, triangles)
            draw_separatrices(sheet, view)
            _draw_curves(sheet, view, triangles)
            draw_marks(sheet, view)
            _draw_singularities(sheet, view, triangles)
            _draw_axes(sheet, view, eye)
        _write_legend(sheet, view, size[1] / pixel_ratio(size))
        _draw_bar(sheet, view, size[0] / pixel_ratio(size), eye.limits)
        if path.suffix.lower() == ".svg":
            said = {"Date": None, "Description": about or None}
            FigureCanvasSVG(figure).print_svg(path, metadata=said)
        else:
            said = {"CreationDate": None, "Keywords": about or None}
            FigureCanvasPdf(figure).print_pdf(path, metadata=said)


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


def _draw_crosses(sheet: Sheet, view: SceneView, triangles: Triangles) -> None:
    settings = view.layer("crosses")
    shown = settings.visible and view.cover != "quads"
    if shown and view.u is not None and view.v is not None:
        glyphs = CrossGlyphs(triangles, settings.density)
        ends = glyphs.ends(
            view.u, view.v, view.H, settings.size, settings.uniform, view.half_log_aspect
        )
        segments = ends.reshape(-1, 2, 3)
        sheet.lines(segments, CROSS, WIDTH["crosses"], TOWARDS["crosses"], settings.opacity)


def _draw_curves(sheet: Sheet, view: SceneView, triangles: Triangles) -> None:
    points = triangles.points
    boundary, cut, features = map(view.layer, ("boundary", "cut", "features"))
    for edges, color in ((view.features, FEATURE), (view.missed, PROBLEM)):
        if features.visible and edges is not None and len(edges):
            width = WIDTH["features"] * features.size
            sheet.lines(points[edges], color, width, TOWARDS["features"], round_ends=True)
    if boundary.visible:
        segments, width = points[triangles.boundary_edges], WIDTH["boundary"] * boundary.size
        ink = THEMES[view.background].ink
        sheet.lines(segments, ink, width, TOWARDS["boundary"], round_ends=True)
    if cut.visible and view.cut_graph is not None and len(view.cut_graph):
        lengths = (CUT_DASH * triangles.diagonal, CUT_GAP * triangles.diagonal)
        ends, pairs = dashes(points, view.cut_graph, *lengths)
        for color, name in ((CUT_HALO, "cut halo"), (CUT, "cut")):
            width = WIDTH[name] * cut.size
            sheet.lines(ends[pairs], color, width, TOWARDS["cut"], cut.opacity)
    if view.loop is not None and len(view.loop) > 1:
        segments = np.stack([points[view.loop[:-1]], points[view.loop[1:]]], axis=1)
        sheet.lines(
            segments, view.loop_color or LOOP, WIDTH["loop"], TOWARDS["loop"], round_ends=True
        )


def _draw_singularities(sheet: Sheet, view: SceneView, triangles: Triangles) -> None:
    settings = view.layer("singularities")
    if settings.visible and view.singularities:
        radius = marker_radius(view.singularities, triangles.diagonal, settings.size)
        centres = np.array([m.position for m in view.singularities], float)
        colors = [(*DISC_PAINTS, valence_color(m.valence)) for m in view.singularities]
        sheet.discs(centres, radius, TOWARDS["singularities"], colors, DISC_PARTS)


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


def _draw_bar(sheet: Sheet, view: SceneView, width: float, limits: tuple[float, float]) -> None:
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
    words = bar_texts(shown, limits)
    for word, y in zip(words, np.linspace(levels[0], levels[-1], len(words)), strict=True):
        sheet.word(word, (left - legend.BAR_GAP, float(y)), ink, "right", legend.TEXT_SIZE)
    above = (right, float(levels[-1]) + legend.BAR_TITLE)
    sheet.word(SCALARS[shown].title, above, ink, "right", legend.TEXT_SIZE + 1.0)
