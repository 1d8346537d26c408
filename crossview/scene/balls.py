"""Balls painted as flat signs that face the eye, none cut by the surface that it lies on."""

from __future__ import annotations

from typing import Any

import numpy as np
import pyvista as pv
from vtkmodules.util.numpy_support import numpy_to_vtk

from crossview.scene.actors import MeshActor, set_cell_colors
from crossview.view.colors import rgb
from crossview.view.geometry import FloatArray, IntArray

RIM = "#16181c"
"""Colour of the rims."""

_AWAY = """//VTK::Light::Impl
  vec3 eye = cameraParallel != 0 ? vec3(0.0, 0.0, 1.0) : normalize(-vertexVC.xyz);
  float facing = clamp(abs(dot(normalize(normalVCVSOutput), eye)), 0.0, 1.0);
  float away = sqrt(1.0 - facing * facing);
"""
"""A ball painted by how far its normal leans from the eye: a disc in every view, of the right
size and hidden by what is before it.
"""

_DISC = (
    _AWAY
    + """
  vec3 color = mix(diffuseColor, vec3(1.0), smoothstep(0.74, 0.78, away));
  fragOutput0 = vec4(mix(color, vec3({rim}), smoothstep(0.90, 0.94, away)), opacity);
"""
)
"""So a ball is painted as a disc."""

RING = (
    _AWAY
    + """
  if (away < 0.80) discard;
  float edge = 1.0 - smoothstep(0.84, 0.86, away) + smoothstep(0.93, 0.95, away);
  fragOutput0 = vec4(mix(diffuseColor, vec3(1.0), edge), opacity);
"""
)
"""And so as a ring."""

LOCK = (
    _AWAY
    + """
  vec2 at = (normalize(normalVCVSOutput) - facing * eye).xy;
  float soft = 0.7 * fwidth(at.x);
  float body = max(abs(at.x) - 0.30, abs(at.y + 0.16) - 0.22);
  float bow = max(abs(length(at - vec2(0.0, 0.06)) - 0.19) - 0.06, 0.06 - at.y);
  float outside = dot(normalVCVSOutput, eye) > 0.0 ? min(body, bow) : 1.0;
  if (outside > soft) discard;
  float light = dot(diffuseColor, vec3(0.30, 0.59, 0.11));
  vec3 ink = light > 0.55 ? vec3({rim}) : vec3(1.0);
  fragOutput0 = vec4(mix(ink, diffuseColor, smoothstep(-soft, soft, outside)), opacity);
"""
)
"""And so the lock on a disc of the same place and colour."""


_NEARER_DEC = """//VTK::PositionVC::Dec
in vec3 facing;
"""
"""Declares the normal of the surface at a ball's place, as long as the ball's radius."""

_NEARER = """//VTK::PositionVC::Impl
  float radius = length(facing);
  bool parallel = MCDCMatrix[0][3] == 0.0 && MCDCMatrix[1][3] == 0.0 && MCDCMatrix[2][3] == 0.0;
  vec3 centre = vertexVCVSOutput.xyz - radius * (normalMatrix * normalMC);
  vec3 towards = parallel ? vec3(0.0, 0.0, 1.0) : normalize(-centre);
  float slope = radius > 0.0 ? dot(normalMatrix * facing, towards) / radius : -1.0;
  slope = twoSided != 0 && radius > 0.0 ? abs(slope) : slope;
  if (slope > {behind}) {{
    float by = radius * min(1.0 / max(slope, 0.01), {most});
    vec3 moved = vertexMC.xyz + by * (transpose(normalMatrix) * towards);
    vec4 nearer = MCDCMatrix * vec4(moved, 1.0);
    gl_Position.z = nearer.z / nearer.w * gl_Position.w;
  }} else if (radius > 0.0) {{
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
  }}
"""
"""A ball lies before all of the surface about it: as far as that rises within its radius. One on
the far side is not seen at all.

The surface about a place that is seen at a slant rises by the radius over the cosine; at the
silhouette by the square root of the radius times twice that of the surface's bend, which `_MOST`
bounds. Only the depth is moved, so nothing changes its place in the picture. All corners of a ball
go by its centre, so that none is torn.
"""

_MOST, _BEHIND = 8.0, -0.15
"""Radii that a ball is moved at most, and the cosine from which on it is on the far side. Chosen:
on a sphere, discs of the usual size are whole up to the silhouette.
"""


class Balls:
    """Any number of balls of one shader in one dataset, by default rimmed discs."""

    def __init__(self, plotter: pv.BasePlotter, name: str, shader: str = _DISC) -> None:
        self._actor = MeshActor(plotter, name)
        paint = shader.format(rim=", ".join(f"{part:.4f}" for part in rgb(RIM)))
        self._shader = self._actor.actor.GetShaderProperty()
        self._shader.AddFragmentShaderReplacement("//VTK::Light::Impl", True, paint, False)
        self._shader.AddVertexShaderReplacement("//VTK::PositionVC::Dec", True, _NEARER_DEC, False)
        nearer = _NEARER.format(behind=_BEHIND, most=_MOST)
        self._shader.AddVertexShaderReplacement("//VTK::PositionVC::Impl", True, nearer, False)
        self._actor.mapper.MapDataArrayToVertexAttribute("facing", "facing", 0, -1)
        self._actor.mapper.SetVBOShiftScaleMethod(0)  # the shader adds to coordinates as they are
        self._actor.property.SetInterpolationToPhong()
        ball = pv.Sphere(radius=1.0, theta_resolution=40, phi_resolution=32)
        self._unit: FloatArray = np.asarray(ball.points)
        self._faces: IntArray = np.asarray(ball.regular_faces)
        self.property = self._actor.property

    def show(
        self,
        centres: FloatArray,
        radius: float,
        colors: list[str],
        normals: FloatArray,
        side: int,
    ) -> None:
        """Draw balls.

        Parameters
        ----------
        centres : (k, 3) float
        radius : float
        colors : list of str
        normals : (k, 3) float
            Of the surface there, of any length; zero where it is not known.
        side : int
            1 or -1: the surface is seen from the side that normals point to, or from the other; 0:
            from both.
        """
        k = len(colors)
        points = (centres[:, None] + radius * self._unit).reshape(-1, 3)
        if self._actor.mesh.n_points == len(points):
            if k:
                self._actor.move(points)
        else:
            first = len(self._unit) * np.arange(k)[:, None, None]
            self._actor.replace(points, faces=(self._faces + first).reshape(-1, 3))
            own: Any = np.tile(self._unit, (k, 1)).astype(np.float32)
            self._actor.mesh.GetPointData().SetNormals(pv.convert_array(own, "Normals"))
        if k:
            self._face(radius * (side or 1), normals)
            self._shader.GetVertexCustomUniforms().SetUniformi("twoSided", int(side == 0))
            rows = np.array([rgb(color) for color in colors]) * 255.0
            cells = np.repeat(np.round(rows), len(self._faces), axis=0)
            set_cell_colors(self._actor.mesh, self._actor.mapper, cells)
        self._actor.visible = k > 0

    def _face(self, radius: float, normals: FloatArray) -> None:
        """Give all points of a ball the normal of the surface there, as long as `radius`."""
        lengths = np.linalg.norm(normals, axis=1, keepdims=True)
        scaled = radius * normals / np.where(lengths > 0.0, lengths, 1.0)
        array = numpy_to_vtk(np.repeat(scaled, len(self._unit), axis=0).astype(np.float32), True)
        array.SetName("facing")
        self._actor.mesh.GetPointData().AddArray(array)

    def remove(self) -> None:
        """Take them off the plotter."""
        self._actor.remove()
