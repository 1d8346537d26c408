"""From a place in the viewport to a point of the surface, by a ray of our own."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pyvista as pv
from numpy.typing import NDArray
from vtkmodules.vtkCommonCore import mutable
from vtkmodules.vtkCommonDataModel import vtkStaticCellLocator
from vtkmodules.vtkRenderingCore import vtkRenderer

from crossview.view.values import Plane, Polylines
from solvers.surface import SurfacePoint, TriSurface

Place = tuple[float, float]
"""Device pixels from the lower left, as VTK counts."""

SLIP = 1e-9
"""How far a ray may pass beside a triangle, over the surface's size, and still meet it: one
through a vertex meets, by rounding, none of the triangles around it."""


@dataclass(frozen=True)
class Pick:
    """Where a ray meets the surface first.

    Parameters
    ----------
    point : SurfacePoint
    position : (3,) float
        The same in space.
    """

    point: SurfacePoint
    position: tuple[float, float, float]


class Picker:
    """Casts rays on one surface; a plain cell picker would take a thousand times as long."""

    def __init__(self, renderer: vtkRenderer) -> None:
        self._renderer = renderer
        self._surface: TriSurface | None = None
        self._clip: Plane | None = None
        self._locator: vtkStaticCellLocator | None = None

    def aim(self, surface: TriSurface | None, clip: Plane | None = None) -> None:
        """Pick on `surface`, what `clip` leaves of it; its locator is built when first asked."""
        self._clip = clip
        if surface is not self._surface:
            self._surface = surface
            self._locator = None

    def pick(self, place: Place) -> Pick | None:
        """Return what the ray through `place` hits first."""
        if self._surface is None:
            return None
        near, far = self._ray(place)
        if self._clip is not None:
            high, low = self._clip.before(np.array([near, far]))
            if low > 0 and high > 0:
                return None
            if high > 0:  # from the plane on
                near = (np.array(near) + high / (high - low) * np.subtract(far, near)).tolist()
            elif low > 0:
                far = (np.array(far) + low / (low - high) * np.subtract(near, far)).tolist()
        t, hit, corners = mutable(0.0), [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]
        sub_cell, face = mutable(0), mutable(-1)
        locator = self._built(self._surface)
        reach = SLIP * self._surface.diagonal
        if not locator.IntersectWithLine(near, far, reach, t, hit, corners, sub_cell, face):
            return None
        r, s = min(max(corners[0], 0.0), 1.0), min(max(corners[1], 0.0), 1.0)
        point = self._surface.point(int(face), (max(1.0 - r - s, 0.0), r, min(s, 1.0 - r)))
        return Pick(point, (hit[0], hit[1], hit[2]))

    def nearest(
        self, place: Place, positions: NDArray[np.float64], radius: float, reach: float
    ) -> int | None:
        """Return which of `positions` is drawn under `place`.

        Parameters
        ----------
        place : Place
        positions : (k, 3) float
            Centres of discs on the surface.
        radius : float
            Of the discs, in space.
        reach : float
            Device pixels around a centre that count in any case.
        """
        best: tuple[float, int] | None = None
        for index, position in enumerate(positions):
            centre = self._display(position)
            rim = self._display(position + radius * self._sideways())
            distance = float(np.hypot(centre[0] - place[0], centre[1] - place[1]))
            size = float(np.hypot(rim[0] - centre[0], rim[1] - centre[1]))
            near_enough = distance <= max(size, reach) and (best is None or distance < best[0])
            if near_enough and self._visible(position, centre, radius):
                best = (distance, index)
        return None if best is None else best[1]

    def curve(self, place: Place, curves: Polylines, reach: float) -> int | None:
        """Return which of curves on the surface is drawn under `place`.

        Parameters
        ----------
        place : Place
        curves : Polylines
        reach : float
            Device pixels beside a curve that count as on it.
        """
        pick, segments = self.pick(place), curves.segments
        if pick is None or not len(segments):
            return None
        start, end = curves.points[segments[:, 0]], curves.points[segments[:, 1]]
        along, away = end - start, pick.position - start
        size = np.maximum((along**2).sum(axis=1), np.finfo(float).tiny)
        part = np.clip((along * away).sum(axis=1) / size, 0.0, 1.0)
        nearest = start + part[:, None] * along
        best = int(np.linalg.norm(nearest - pick.position, axis=1).argmin())
        x, y = self._display(nearest[best])
        if np.hypot(x - place[0], y - place[1]) > reach:
            return None
        return int(np.searchsorted(curves.offsets, segments[best, 0], side="right")) - 1

    def within(
        self, low: Place, high: Place, positions: NDArray[np.float64], radius: float
    ) -> tuple[int, ...]:
        """Return which of `positions`, centres of discs, are seen between two places."""
        found = []
        for index, position in enumerate(positions):
            x, y = centre = self._display(position)
            inside = low[0] <= x <= high[0] and low[1] <= y <= high[1]
            if inside and self._visible(position, centre, radius):
                found.append(index)
        return tuple(found)

    def beside(self, position: NDArray[np.float64], by: Place) -> Pick | None:
        """Return what the ray hits that passes a position of space at a distance in the picture."""
        x, y = self._display(position)
        return self.pick((x + by[0], y + by[1]))

    def _visible(self, position: NDArray[np.float64], centre: Place, radius: float) -> bool:
        """Whether nothing is before it; a ray may slip between triangles and hit the far side."""
        if self._clip is not None and self._clip.before(position) > 0:
            return False
        pick = self.pick(centre)
        if pick is None:
            return True
        eye = np.array(self._ray(centre)[0])
        away, hit = (float(np.linalg.norm(at - eye)) for at in (position, pick.position))
        return hit >= away - 2.0 * radius

    def _sideways(self) -> NDArray[np.float64]:
        """Return the unit vector to the right of the picture."""
        camera = self._renderer.GetActiveCamera()
        right = np.cross(camera.GetDirectionOfProjection(), camera.GetViewUp())
        return np.asarray(right / np.linalg.norm(right))

    def _display(self, position: NDArray[np.float64]) -> Place:
        self._renderer.SetWorldPoint(*position, 1.0)
        self._renderer.WorldToDisplay()
        x, y, _ = self._renderer.GetDisplayPoint()
        return x, y

    def _ray(self, place: Place) -> tuple[list[float], list[float]]:
        ends = []
        for depth in (0.0, 1.0):
            self._renderer.SetDisplayPoint(*place, depth)
            self._renderer.DisplayToWorld()
            x, y, z, w = self._renderer.GetWorldPoint()
            ends.append([x / w, y / w, z / w])
        return ends[0], ends[1]

    def _built(self, surface: TriSurface) -> vtkStaticCellLocator:
        if self._locator is None:
            self._locator = vtkStaticCellLocator()
            self._locator.SetDataSet(
                pv.PolyData.from_regular_faces(surface.vertices, surface.faces)
            )
            self._locator.BuildLocator()
        return self._locator
