"""Crosses, curves and singularities as vectors on an easel."""

from __future__ import annotations

import numpy as np

from crossview.export.easel import Easel
from crossview.export.vector_meshes import draw_marks, draw_quads, draw_separatrices
from crossview.scene import SceneView
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
    valence_color,
)
from crossview.view.geometry import Triangles, dashes
from crossview.view.style import TOWARDS, WIDTH


def draw_in_space(on: Easel, view: SceneView, triangles: Triangles) -> None:
    """Draw all of a view that lies on the surface, from below up."""
    draw_quads(on, view, triangles)
    draw_crosses(on, view, triangles)
    draw_separatrices(on, view)
    draw_curves(on, view, triangles)
    draw_marks(on, view)
    draw_singularities(on, view, triangles)


def draw_crosses(on: Easel, view: SceneView, triangles: Triangles) -> None:
    """Draw the crosses, which quads stand in for."""
    settings = view.layer("crosses")
    shown = settings.visible and view.cover != "quads"
    if shown and view.u is not None and view.v is not None:
        glyphs = CrossGlyphs(triangles, settings.density)
        ends = glyphs.ends(
            view.u, view.v, view.H, settings.size, settings.uniform, view.half_log_aspect
        )
        segments = ends.reshape(-1, 2, 3)
        on.lines(segments, CROSS, WIDTH["crosses"], TOWARDS["crosses"], settings.opacity)


def draw_curves(on: Easel, view: SceneView, triangles: Triangles) -> None:
    """Draw features, boundary, cut graph and the loop that is pointed out."""
    points = triangles.points
    boundary, cut, features = map(view.layer, ("boundary", "cut", "features"))
    for edges, color in ((view.features, FEATURE), (view.missed, PROBLEM)):
        if features.visible and edges is not None and len(edges):
            width = WIDTH["features"] * features.size
            on.lines(points[edges], color, width, TOWARDS["features"], round_ends=True)
    if boundary.visible:
        segments, width = points[triangles.boundary_edges], WIDTH["boundary"] * boundary.size
        ink = THEMES[view.background].ink
        on.lines(segments, ink, width, TOWARDS["boundary"], round_ends=True)
    if cut.visible and view.cut_graph is not None and len(view.cut_graph):
        lengths = (CUT_DASH * triangles.diagonal, CUT_GAP * triangles.diagonal)
        ends, pairs = dashes(points, view.cut_graph, *lengths)
        for color, name in ((CUT_HALO, "cut halo"), (CUT, "cut")):
            width = WIDTH[name] * cut.size
            on.lines(ends[pairs], color, width, TOWARDS["cut"], cut.opacity)
    if view.loop is not None and len(view.loop) > 1:
        segments = np.stack([points[view.loop[:-1]], points[view.loop[1:]]], axis=1)
        on.lines(segments, view.loop_color or LOOP, WIDTH["loop"], TOWARDS["loop"], round_ends=True)


def draw_singularities(on: Easel, view: SceneView, triangles: Triangles) -> None:
    """Draw the singularities in the colours of their valences."""
    settings = view.layer("singularities")
    if settings.visible and view.singularities:
        radius = marker_radius(view.singularities, triangles.diagonal, settings.size)
        centres = np.array([m.position for m in view.singularities], float)
        colors = [(*DISC_PAINTS, valence_color(m.valence)) for m in view.singularities]
        on.discs(centres, radius, TOWARDS["singularities"], colors, DISC_PARTS)
