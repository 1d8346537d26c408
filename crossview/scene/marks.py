"""Signs of one size at every distance: "T" at T-junctions, "!" at what is poor.

That is boundaries that the field misses, and of quads the worst.
"""

from __future__ import annotations

import numpy as np
import pyvista as pv

from crossview.scene.actors import MeshActor
from crossview.scene.watch import Watch
from crossview.view.colors import MARK_INK, MARK_PAPER, MARK_WARNING, rgb
from crossview.view.geometry import FloatArray, Triangles
from crossview.view.scene_view import SceneView

MARK_SIZE = 19.0
"""Diameter of a sign in pixels of the window."""
RIM = 0.09
"""Width of its rim; this and the strokes in diameters, from its centre to the right and up."""
STROKES = {
    "T": ((-0.23, 0.15, 0.23, 0.25), (-0.055, -0.26, 0.055, 0.2)),
    "!": ((-0.06, -0.05, 0.06, 0.29), (-0.06, -0.27, 0.06, -0.15)),
}
"""Boxes (left, low, right, high) that a sign's letter is made of."""
INKS = {"T": MARK_INK, "!": MARK_WARNING}
"""Colour of the sign."""

_SIGN = """//VTK::Light::Impl
  vec2 at = vec2(gl_PointCoord.x - 0.5, 0.5 - gl_PointCoord.y);
  float soft = 0.7 * fwidth(at.x);
  float away = length(at);
  if (away > 0.5) discard;
  vec2 outside;
  float ink = smoothstep({inner} - soft, {inner} + soft, away);
{strokes}
  fragOutput0 = vec4(mix(vec3({paper}), vec3({ink}), ink), opacity);
"""
"""A point is drawn as a square of pixels that face the eye; this makes a sign of it."""

_STROKE = """
  outside = abs(at - vec2({x}, {y})) - vec2({half_width}, {half_height});
  ink = max(ink, 1.0 - smoothstep(-soft, soft, max(outside.x, outside.y)));
"""
"""One stroke of the sign."""


class MarksLayer:
    """The T and ! marks: points in space, each drawn as a sign."""

    def __init__(self, plotter: pv.BasePlotter, pixel_ratio: float) -> None:
        self._signs = {letter: _Signs(plotter, letter) for letter in STROKES}
        self._pixel_ratio = pixel_ratio

    def show(self, view: SceneView, triangles: Triangles | None) -> None:
        """Apply what changed."""
        settings = view.layer("marks")
        shown = settings.visible and triangles is not None
        for letter, places in marks_of(view).items():
            size = MARK_SIZE * settings.size * self._pixel_ratio
            self._signs[letter].show(places if shown else None, size)

    def remove(self) -> None:
        """Take the marks off the plotter."""
        for signs in self._signs.values():
            signs.remove()


def marks_of(view: SceneView) -> dict[str, FloatArray | None]:
    """Return where each sign is to be, (k, 3), by its letter."""
    return {"T": view.t_junctions, "!": view.worst if view.cover == "quads" else view.misaligned}


class _Signs:
    """Any number of one sign in one dataset."""

    def __init__(self, plotter: pv.BasePlotter, letter: str) -> None:
        self._actor = MeshActor(plotter, f"{letter} marks")
        self._actor.actor.GetShaderProperty().AddFragmentShaderReplacement(
            "//VTK::Light::Impl", True, _shader(letter), False
        )
        self._actor.property.SetRepresentationToPoints()
        self._watch = Watch()

    def show(self, places: FloatArray | None, size: float) -> None:
        """Draw it at places (k, 3)."""
        if places is None or not len(places):
            self._actor.visible = False
            return
        if self._watch.changed("places", places):
            self._actor.replace(places)
            ones = np.ones(len(places), int)
            self._actor.mesh.verts = np.stack([ones, np.arange(len(places))], axis=1).ravel()
        self._actor.property.SetPointSize(size)
        self._actor.visible = True

    def remove(self) -> None:
        self._actor.remove()


def _shader(letter: str) -> str:
    strokes = ""
    for left, low, right, high in STROKES[letter]:
        strokes += _STROKE.format(
            x=_number((left + right) / 2.0),
            y=_number((low + high) / 2.0),
            half_width=_number((right - left) / 2.0),
            half_height=_number((high - low) / 2.0),
        )
    paper, ink = (", ".join(map(_number, rgb(c))) for c in (MARK_PAPER, INKS[letter]))
    return _SIGN.format(inner=_number(0.5 - RIM), strokes=strokes, paper=paper, ink=ink)


def _number(value: float) -> str:
    return f"{value:.4f}"
