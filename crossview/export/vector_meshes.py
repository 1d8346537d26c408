"""Separatrices, marks, layouts and quads as vectors on a on."""

from __future__ import annotations

import numpy as np

from crossview.export.easel import Easel
from crossview.scene import SceneView
from crossview.scene.marks import INKS, MARK_SIZE, RIM, STROKES, marks_of
from crossview.scene.quads import irregular_radius
from crossview.scene.separatrices import curve_height, separatrix_color
from crossview.scene.singularities import DISC_PAINTS, DISC_PARTS
from crossview.view.colors import CUT_HALO, MARK_PAPER, QUAD_EDGE, THEMES, valence_color
from crossview.view.geometry import Triangles
from crossview.view.quad_geometry import QuadGeometry
from crossview.view.style import TOWARDS, WIDTH


def draw_quads(on: Easel, view: SceneView, triangles: Triangles) -> None:
    """Draw edges and irregular vertices of quads, or borders of patches."""
    cover = view.cover
    mesh = {"quads": view.quads, "layout": view.layout}.get(cover)
    if mesh is None:
        return
    settings, geometry = view.layer(cover), QuadGeometry(mesh)
    ink = QUAD_EDGE if cover == "quads" else THEMES[view.background].ink
    edges = geometry.edges if cover == "quads" else geometry.borders
    if settings.edges:
        width, towards = WIDTH[cover] * settings.size, TOWARDS["layout borders"]
        on.lines(mesh.points[edges], ink, width, towards, round_ends=True)
    if cover == "quads" and len(mesh.irregular):
        colors = [(*DISC_PAINTS, valence_color(int(n))) for n in mesh.valences]
        radius = irregular_radius(view, triangles)
        on.discs(mesh.irregular, radius, TOWARDS["irregular"], colors, DISC_PARTS)


def draw_separatrices(on: Easel, view: SceneView) -> None:
    """Draw separatrices, each with a light rim."""
    settings, curves = view.layer("separatrices"), view.separatrices
    if not settings.visible or curves is None:
        return
    segments, valences = curves.points[curves.segments], curves.segment_valences
    width, towards = WIDTH["separatrices halo"] * settings.size, curve_height(view, "separatrices")
    on.lines(segments, CUT_HALO, width, towards, settings.opacity, round_ends=True)
    for valence in np.unique(valences):
        color, width = separatrix_color(int(valence)), WIDTH["separatrices"] * settings.size
        chosen = segments[valences == valence]
        on.lines(chosen, color, width, towards, settings.opacity, round_ends=True)


def draw_marks(on: Easel, view: SceneView) -> None:
    """Draw the T and ! marks."""
    settings = view.layer("marks")
    for letter, places in marks_of(view).items():
        if settings.visible and places is not None and len(places):
            diameter, towards = MARK_SIZE * settings.size, TOWARDS[f"{letter} marks"]
            paints = (INKS[letter], MARK_PAPER)
            on.signs(places, diameter, towards, STROKES[letter], paints, RIM)
