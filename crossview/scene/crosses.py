"""The crosses layer: four arms on well spread places, all in one dataset of lines."""

from __future__ import annotations

import numpy as np
import pyvista as pv

from crossview.scene.actors import MeshActor
from crossview.scene.watch import Watch
from crossview.view.colors import CROSS
from crossview.view.geometry import FloatArray, Triangles
from crossview.view.sampling import usual_sites
from crossview.view.scene_view import SceneView
from crossview.view.style import WIDTH

_ARM = 0.38
"""Half the length of a middling cross, in distances between crosses. Chosen: they do not touch."""

_SMALLEST, _LARGEST = 0.3, 1.75
"""Sizes are shown within these factors of the middling one. Chosen, so that all stay readable."""


class CrossesLayer:
    """Lines from -u to u and from -v to v about each place."""

    def __init__(self, plotter: pv.BasePlotter, pixel_ratio: float) -> None:
        self._actor = MeshActor(plotter, "crosses")
        self._actor.flat()
        self._actor.color(CROSS)
        self._actor.property.SetLineWidth(WIDTH["crosses"] * pixel_ratio)
        self._watch = Watch()
        self._glyphs: CrossGlyphs | None = None

    def show(self, view: SceneView, triangles: Triangles | None) -> None:
        """Apply what changed."""
        settings = view.layer("crosses")
        hidden = not settings.visible or view.cover == "quads"
        if hidden or triangles is None or view.u is None or view.v is None:
            self._actor.visible = False
            return
        fresh = self._watch.changed("chosen", triangles, settings.density)
        if fresh or self._glyphs is None:
            self._glyphs = CrossGlyphs(triangles, settings.density)
        style = (settings.size, settings.uniform)
        half = view.half_log_aspect
        if self._watch.changed("field", view.H, view.u, view.v, half, style) or fresh:
            points = self._glyphs.ends(view.u, view.v, view.H, *style, half)
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
    """The places on a surface that carry a cross, and where the arms of the crosses end.

    Parameters
    ----------
    triangles : Triangles
    density : float
        Factor on the automatic number.
    """

    def __init__(self, triangles: Triangles, density: float) -> None:
        self.sites = usual_sites(triangles, density)
        self._corners = triangles.faces[self.sites.faces]
        self._longest = 0.95 * self.sites.free

    def ends(
        self,
        u: FloatArray,
        v: FloatArray,
        H: FloatArray | None,
        size: float,
        uniform: bool,
        half_log_aspect: FloatArray | None = None,
    ) -> FloatArray:
        """Return (4 k, 3): for each cross the ends of its line along u, then along v."""
        sites = self.sites
        arms = np.full((2, len(sites.faces)), _ARM * size * sites.spacing)
        if H is not None and not uniform:
            h = np.einsum("kc,kc->k", H[self._corners], sites.weights)
            half = np.zeros_like(h)
            if half_log_aspect is not None:
                half = np.einsum("kc,kc->k", half_log_aspect[sites.faces], sites.weights)
            sizes = np.exp(np.stack([h - half, h + half]) - np.median(h))
            arms *= np.clip(sizes, _SMALLEST, _LARGEST)
        arms = np.minimum(arms, self._longest)[:, :, None]
        along, across = arms[0] * u[sites.faces], arms[1] * v[sites.faces]
        c = sites.positions
        return np.stack([c - along, c + along, c - across, c + across], axis=1).reshape(-1, 3)
