"""The validity guide: where the singularity under the mouse may go."""

from __future__ import annotations

import numpy as np
import pyvista as pv

from crossview.scene.actors import MeshActor, set_cell_colors
from crossview.scene.colors import CUT_HALO
from crossview.scene.geometry import IntArray, Triangles
from crossview.scene.overlay import bytes_of
from crossview.scene.style import WIDTH
from crossview.scene.values import GuideLine
from crossview.scene.view import SceneView
from crossview.scene.watch import Watch


class GuideLayer:
    """Lines to follow: thin, and thick with a light rim those that are emphasised."""

    def __init__(self, plotter: pv.BasePlotter, pixel_ratio: float) -> None:
        self._thin = MeshActor(plotter, "guide")
        self._halo = MeshActor(plotter, "strong guide halo")
        self._thick = MeshActor(plotter, "strong guide")
        self._halo.color(CUT_HALO)
        for actor in self._actors:
            actor.flat()
        self._pixel_ratio = pixel_ratio
        self._watch = Watch()

    def show(self, view: SceneView, triangles: Triangles | None) -> None:
        """Apply what changed."""
        settings = view.layer("guide")
        if not settings.visible or triangles is None or not view.guide:
            for actor in self._actors:
                actor.visible = False
            return
        if self._watch.changed("lines", view.guide):
            strong = [line for line in view.guide if line.strong]
            _fill(self._thin, [line for line in view.guide if not line.strong])
            _fill(self._thick, strong)
            self._halo.replace(self._thick.mesh.points, lines=_pairs(strong))
        for actor, name in zip(
            self._actors, ("guide", "strong guide halo", "strong guide"), strict=True
        ):
            actor.property.SetLineWidth(WIDTH[name] * settings.size * self._pixel_ratio)
            actor.visible = True

    def remove(self) -> None:
        """Take the guide off the plotter."""
        for actor in self._actors:
            actor.remove()

    @property
    def _actors(self) -> tuple[MeshActor, MeshActor, MeshActor]:
        return self._thin, self._halo, self._thick


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
