"""The crosses layer: four arms on a well spread choice of triangles, one dataset of lines."""

from __future__ import annotations

import numpy as np
import pyvista as pv

from crossview.scene.actors import MeshActor
from crossview.scene.colors import CROSS
from crossview.scene.geometry import FloatArray, IntArray, Triangles
from crossview.scene.sampling import spread_faces
from crossview.scene.view import SceneView
from crossview.scene.watch import Watch

# How many crosses there are at density 1 (fewer on a coarse surface).
AUTOMATIC_NUMBER = 3000
# Half the length of a middling cross, in distances between crosses.
_ARM = 0.4
# exp(H) is shown within these factors of the middling size, so that all stay readable.
_SMALLEST, _LARGEST = 0.3, 1.75
_LINE_WIDTH = 1.25


class CrossesLayer:
    """Lines -u to u and -v to v about the chosen barycentres."""

    def __init__(self, plotter: pv.BasePlotter, pixel_ratio: float) -> None:
        self._actor = MeshActor(plotter, "crosses", towards=30.0)
        self._actor.flat()
        self._actor.color(CROSS)
        self._actor.property.SetLineWidth(_LINE_WIDTH * pixel_ratio)
        self._watch = Watch()
        self._glyphs: CrossGlyphs | None = None

    def show(self, view: SceneView, triangles: Triangles | None) -> None:
        """Apply what changed."""
        settings = view.layer("crosses")
        if not settings.visible or triangles is None or view.u is None or view.v is None:
            self._actor.visible = False
            return
        fresh = self._watch.changed("chosen", triangles, settings.density)
        if fresh or self._glyphs is None:
            self._glyphs = CrossGlyphs(triangles, AUTOMATIC_NUMBER * settings.density)
        style = (settings.size, settings.uniform)
        if self._watch.changed("field", view.H, view.u, view.v, style) or fresh:
            points = self._glyphs.ends(view.u, view.v, view.H, *style)
            if fresh:
                self._actor.replace(points, lines=np.arange(len(points)).reshape(-1, 2))
            else:
                self._actor.move(points)
        self._actor.property.SetOpacity(settings.opacity)
        self._actor.visible = True

    def remove(self) -> None:
        """Take the crosses off the plotter."""
        self._actor.remove()


class CrossGlyphs:
    """The chosen faces of a surface, and where the arms of their crosses end.

    Parameters
    ----------
    triangles : Triangles
    number : float
        Of crosses wanted.
    """

    def __init__(self, triangles: Triangles, number: float) -> None:
        self.chosen: IntArray = spread_faces(
            triangles.barycentres, triangles.normals, triangles.areas, number
        )
        self.centres: FloatArray = triangles.barycentres[self.chosen]
        self._corners = triangles.faces[self.chosen]
        self.distance = float(np.sqrt(triangles.areas.sum() / max(len(self.chosen), 1)))

    def ends(
        self, u: FloatArray, v: FloatArray, H: FloatArray | None, size: float, uniform: bool
    ) -> FloatArray:
        """Return (4 k, 3): for each cross the ends of its line along u, then along v."""
        arm = np.full((len(self.chosen), 1), _ARM * size * self.distance)
        if H is not None and not uniform:
            h = H[self._corners].mean(axis=1)
            arm *= np.clip(np.exp(h - np.median(h)), _SMALLEST, _LARGEST)[:, None]
        along, across = arm * u[self.chosen], arm * v[self.chosen]
        c = self.centres
        return np.stack([c - along, c + along, c - across, c + across], axis=1).reshape(-1, 3)
