"""Offending faces, edges and vertices in red, in front of all else."""

from __future__ import annotations

import numpy as np
import pyvista as pv

from crossview.scene.actors import MeshActor
from crossview.scene.watch import Watch
from crossview.view.colors import PROBLEM
from crossview.view.geometry import FloatArray, IntArray, Triangles
from crossview.view.scene_view import SceneView
from crossview.view.style import WIDTH
from crossview.view.values import Elements


class ProblemLayer:
    """Faces filled, edges and outlines of faces as lines, vertices as dots."""

    def __init__(self, plotter: pv.BasePlotter, pixel_ratio: float) -> None:
        self._faces = MeshActor(plotter, "problem faces")
        self._lines = MeshActor(plotter, "problem lines")
        self._dots = MeshActor(plotter, "problem dots")
        self._lines.property.SetLineWidth(WIDTH["problem"] * pixel_ratio)
        self._dots.property.SetPointSize(9.0 * pixel_ratio)
        self._dots.property.RenderPointsAsSpheresOn()
        for actor in self._all():
            actor.flat()
            actor.color(PROBLEM)
        self._watch = Watch()

    def show(self, view: SceneView, triangles: Triangles | None) -> None:
        """Apply what changed."""
        if self._watch.changed("problem", view.problem, triangles):
            problem = view.problem if triangles is not None else None
            if problem is not None and triangles is not None:
                self._replace(problem, triangles)
            for actor in self._all():
                actor.visible = problem is not None

    def remove(self) -> None:
        """Take them off the plotter."""
        for actor in self._all():
            actor.remove()

    def _all(self) -> tuple[MeshActor, ...]:
        return self._faces, self._lines, self._dots

    def _replace(self, problem: Elements, triangles: Triangles) -> None:
        faces = triangles.faces[np.asarray(problem.faces, int)].reshape(-1, 3)
        outlines = faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
        lines = np.vstack([outlines, np.asarray(problem.edges, int).reshape(-1, 2)])
        dots = np.asarray(problem.vertices, int).reshape(-1, 1)
        points, cells = _used(triangles, faces)
        self._faces.replace(points, faces=cells)
        points, cells = _used(triangles, lines)
        self._lines.replace(points, lines=cells)
        self._dots.replace(triangles.points[dots[:, 0]])
        count = self._dots.mesh.n_points
        self._dots.mesh.verts = np.stack([np.ones(count, int), np.arange(count)], axis=1).ravel()


def _used(triangles: Triangles, cells: IntArray) -> tuple[FloatArray, IntArray]:
    """Return the points that cells (k, c) use, and the cells in their numbers."""
    used, numbers = np.unique(cells, return_inverse=True)
    return triangles.points[used], numbers.reshape(cells.shape)
