"""Polylines on the surface: its boundary, features, the cut graph, a loop to point out."""

from __future__ import annotations

import numpy as np
import pyvista as pv

from crossview.scene.actors import MeshActor
from crossview.scene.watch import Watch
from crossview.view.colors import CUT, CUT_HALO, FEATURE, LOOP, PROBLEM, THEMES
from crossview.view.geometry import Triangles, dashes, section
from crossview.view.scene_view import SceneView
from crossview.view.style import WIDTH

CUT_DASH, CUT_GAP = 0.012, 0.008
"""Lengths of the dashes of the cut graph and of the gaps, in diagonals of the surface. Chosen."""


class BoundaryLayer:
    """The edges of one triangle only, in the theme's ink."""

    def __init__(self, plotter: pv.BasePlotter, pixel_ratio: float) -> None:
        self._actor = MeshActor(plotter, "boundary")
        self._actor.flat()
        self._pixel_ratio = pixel_ratio
        self._watch = Watch()

    def show(self, view: SceneView, triangles: Triangles | None) -> None:
        """Apply what changed."""
        if self._watch.changed("triangles", triangles) and triangles is not None:
            self._actor.replace(triangles.points, lines=triangles.boundary_edges)
        settings = view.layer("boundary")
        self._actor.color(THEMES[view.background].ink)
        self._actor.property.SetLineWidth(WIDTH["boundary"] * settings.size * self._pixel_ratio)
        self._actor.visible = settings.visible and triangles is not None

    def remove(self) -> None:
        """Take the boundary off the plotter."""
        self._actor.remove()


class SectionLayer:
    """Where the plane that clips meets the surface, in the theme's ink."""

    def __init__(self, plotter: pv.BasePlotter, pixel_ratio: float) -> None:
        self._actor = MeshActor(plotter, "section")
        self._actor.flat()
        self._actor.property.SetLineWidth(WIDTH["boundary"] * pixel_ratio)
        self._watch = Watch()

    def show(self, view: SceneView, triangles: Triangles | None) -> None:
        """Apply what changed."""
        if triangles is None or view.clip is None:
            self._actor.visible = False
            return
        if self._watch.changed("section", triangles, view.clip):
            ends = section(triangles, view.clip)
            self._actor.replace(ends, lines=np.arange(len(ends)).reshape(-1, 2))
        self._actor.color(THEMES[view.background].ink)
        self._actor.visible = True

    def remove(self) -> None:
        """Take it off the plotter."""
        self._actor.remove()


class FeaturesLayer:
    """Feature edges in violet, in red where the crosses do not follow them."""

    def __init__(self, plotter: pv.BasePlotter, pixel_ratio: float) -> None:
        self._followed = MeshActor(plotter, "features")
        self._missed = MeshActor(plotter, "missed features")
        for actor, color in ((self._followed, FEATURE), (self._missed, PROBLEM)):
            actor.flat()
            actor.color(color)
        self._pixel_ratio = pixel_ratio
        self._watch = Watch()

    def show(self, view: SceneView, triangles: Triangles | None) -> None:
        """Apply what changed."""
        settings = view.layer("features")
        for name, actor, edges in (
            ("followed", self._followed, view.features),
            ("missed", self._missed, view.missed),
        ):
            actor.visible = False
            if not settings.visible or triangles is None or edges is None or not len(edges):
                continue
            if self._watch.changed(name, triangles, edges):
                used, pairs = np.unique(edges, return_inverse=True)
                actor.replace(triangles.points[used], lines=pairs.reshape(-1, 2))
            actor.property.SetLineWidth(WIDTH["features"] * settings.size * self._pixel_ratio)
            actor.visible = True

    def remove(self) -> None:
        """Take them off the plotter."""
        self._followed.remove()
        self._missed.remove()


class CutLayer:
    """The cut graph in blue dashes with a light rim, to be seen on every colour."""

    def __init__(self, plotter: pv.BasePlotter, pixel_ratio: float) -> None:
        self._halo = MeshActor(plotter, "cut halo")
        self._dashes = MeshActor(plotter, "cut")
        for actor, color in ((self._halo, CUT_HALO), (self._dashes, CUT)):
            actor.flat()
            actor.color(color)
        self._pixel_ratio = pixel_ratio
        self._watch = Watch()

    def show(self, view: SceneView, triangles: Triangles | None) -> None:
        """Apply what changed."""
        edges = view.cut_graph
        settings = view.layer("cut")
        actors = (self._halo, self._dashes)
        if not settings.visible or triangles is None or edges is None or not len(edges):
            for actor in actors:
                actor.visible = False
            return
        if self._watch.changed("edges", triangles, edges):
            lengths = (CUT_DASH * triangles.diagonal, CUT_GAP * triangles.diagonal)
            ends, lines = dashes(triangles.points, edges, *lengths)
            for actor in actors:
                actor.replace(ends, lines=lines)
        for actor, name in zip(actors, ("cut halo", "cut"), strict=True):
            actor.property.SetOpacity(settings.opacity)
            actor.property.SetLineWidth(WIDTH[name] * settings.size * self._pixel_ratio)
            actor.visible = True

    def remove(self) -> None:
        """Take the cut graph off the plotter."""
        self._halo.remove()
        self._dashes.remove()


class LoopLayer:
    """A path along vertices, thick, for as long as something points at it."""

    def __init__(self, plotter: pv.BasePlotter, pixel_ratio: float) -> None:
        self._actor = MeshActor(plotter, "loop")
        self._actor.flat()
        self._actor.property.SetLineWidth(WIDTH["loop"] * pixel_ratio)
        self._watch = Watch()

    def show(self, view: SceneView, triangles: Triangles | None) -> None:
        """Apply what changed."""
        path = view.loop
        if triangles is None or path is None or len(path) < 2:
            self._actor.visible = False
            return
        if self._watch.changed("path", triangles, path):
            pairs = np.arange(len(path) - 1)[:, None] + np.array([0, 1])
            self._actor.replace(triangles.points[path], lines=pairs)
        self._actor.color(view.loop_color or LOOP)
        self._actor.visible = True

    def remove(self) -> None:
        """Take the loop off the plotter."""
        self._actor.remove()
