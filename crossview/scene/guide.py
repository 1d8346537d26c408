"""The validity guide: where the singularity under the mouse may go."""

from __future__ import annotations

import numpy as np
import pyvista as pv

from crossview.scene.actors import MeshActor, set_cell_colors
from crossview.scene.watch import Watch
from crossview.view.colors import CUT_HALO, bytes_of
from crossview.view.geometry import IntArray, Triangles
from crossview.view.scene_view import SceneView
from crossview.view.style import WIDTH
from crossview.view.values import GuideLine


class GuideLayer:
    """Lines to follow with a light rim, thick those that are emphasised."""

    def __init__(self, plotter: pv.BasePlotter, pixel_ratio: float) -> None:
        self._actors = {name: MeshActor(plotter, name) for name in (*_of(False), *_of(True))}
        for name, actor in self._actors.items():
            actor.flat()
            if name.endswith("halo"):
                actor.color(CUT_HALO)
        self._pixel_ratio = pixel_ratio
        self._watch = Watch()

    def show(self, view: SceneView, triangles: Triangles | None) -> None:
        """Apply what changed."""
        settings = view.layer("guide")
        shown = settings.visible and triangles is not None and len(view.guide) > 0
        if shown and self._watch.changed("lines", view.guide):
            for strong in (False, True):
                halo, body = (self._actors[name] for name in _of(strong))
                lines = [line for line in view.guide if line.strong is strong]
                _fill(body, lines)
                halo.replace(body.mesh.points, lines=_pairs(lines))
        for name, actor in self._actors.items():
            actor.property.SetLineWidth(WIDTH[name] * settings.size * self._pixel_ratio)
            actor.visible = shown

    def remove(self) -> None:
        """Take the guide off the plotter."""
        for actor in self._actors.values():
            actor.remove()


def _of(strong: bool) -> tuple[str, str]:
    """Return the names of the rim and of the lines."""
    name = "strong guide" if strong else "guide"
    return f"{name} halo", name


def _fill(actor: MeshActor, lines: list[GuideLine]) -> None:
    points = [line.segments.reshape(-1, 3) for line in lines]
    actor.replace(np.concatenate([np.empty((0, 3)), *points]), lines=_pairs(lines))
    if lines:
        which = np.repeat(np.arange(len(lines)), [len(line.segments) for line in lines])
        colors = bytes_of([line.color for line in lines])[which]
        set_cell_colors(actor.mesh, actor.mapper, colors)


def _pairs(lines: list[GuideLine]) -> IntArray:
    count = sum(len(line.segments) for line in lines)
    return np.arange(2 * count).reshape(-1, 2)
