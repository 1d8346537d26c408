"""Cameras: a good first view of a surface, and how it fills the room between the texts."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from vtkmodules.vtkCommonMath import vtkMatrix4x4
from vtkmodules.vtkRenderingCore import vtkCamera

from crossview.view.geometry import FloatArray, Triangles
from solvers.errors import CrossviewError
from solvers.number_checks import LARGEST

VIEW_ANGLE = 24.0
"""From the bottom of the view to its top, degrees. Chosen: little perspective."""

_LYING = 0.35
"""A surface this flat, least by middle extent, lies on its flat side; others stand along y, as most
model files do. Chosen.
"""

PRESETS = ("auto", "iso", "xy", "xz", "yz", "yx", "zx", "zy")
"""Names of usual views."""

_AXES = ("xy", "xz", "yz", "yx", "zx", "zy")
"""Those along an axis; the last three from behind."""


@dataclass(frozen=True)
class Room:
    """Pixels to keep free at the sides of a picture of width and height."""

    width: float
    height: float
    left: float = 0.0
    right: float = 0.0
    top: float = 0.0
    bottom: float = 0.0


@dataclass(frozen=True)
class Camera:
    """Where the eye is, what it looks at, what is up; the width of a parallel view, else None.

    Parameters
    ----------
    position, focus, up : (3,) float
    centre : (float, float)
        Shift of the picture, in half widths and half heights (VTK's window centre).
    parallel_scale : float, optional
        Half the height seen, for a parallel projection.
    """

    position: tuple[float, ...]
    focus: tuple[float, ...]
    up: tuple[float, ...]
    centre: tuple[float, float] = (0.0, 0.0)
    parallel_scale: float | None = None

    @classmethod
    def of(cls, camera: vtkCamera) -> Camera:
        """Return the state of a VTK camera."""
        parallel = camera.GetParallelProjection()
        return cls(
            camera.GetPosition(),
            camera.GetFocalPoint(),
            camera.GetViewUp(),
            camera.GetWindowCenter(),
            camera.GetParallelScale() if parallel else None,
        )

    @property
    def text(self) -> str:
        """As `read_camera` takes it: nine numbers, ten of a parallel view."""
        numbers = [*self.position, *self.focus, *self.up]
        if self.parallel_scale is not None:
            numbers.append(self.parallel_scale)
        return ",".join(f"{number:.9g}" for number in numbers)

    @property
    def other_projection(self) -> Camera:
        """Perspective in place of a parallel view, or back; what is at the focus keeps its size."""
        away = np.subtract(self.position, self.focus)
        tan = np.tan(np.radians(VIEW_ANGLE) / 2.0)
        if self.parallel_scale is None:
            return replace(self, parallel_scale=float(np.linalg.norm(away) * tan))
        away = away / np.linalg.norm(away) * (self.parallel_scale / tan)
        position = tuple((np.asarray(self.focus) + away).tolist())
        return replace(self, position=position, parallel_scale=None)

    def facing(self, place: FloatArray, normal: FloatArray, height: float) -> Camera:
        """Look at a place along the normal there, at so much around it from top to bottom."""
        tan = np.tan(np.radians(VIEW_ANGLE) / 2.0)
        away = np.asarray(normal) * (0.5 * height / tan)
        up = np.asarray(self.up)
        if np.linalg.norm(np.cross(up, away)) < 0.1 * np.linalg.norm(away) * np.linalg.norm(up):
            up = np.subtract(self.position, self.focus)
        return Camera(
            tuple((place + away).tolist()),
            tuple(np.asarray(place).tolist()),
            tuple(_frame(away, up)[1].tolist()),
            parallel_scale=None if self.parallel_scale is None else 0.5 * height,
        )

    def apply(self, camera: vtkCamera) -> None:
        """Set a VTK camera."""
        camera.SetPosition(*self.position)
        camera.SetFocalPoint(*self.focus)
        camera.SetViewUp(*self.up)
        camera.SetWindowCenter(*self.centre)
        camera.SetViewAngle(VIEW_ANGLE)
        camera.SetParallelProjection(self.parallel_scale is not None)
        if self.parallel_scale is not None:
            camera.SetParallelScale(self.parallel_scale)


def camera_for(text: str, triangles: Triangles, room: Room) -> Camera:
    """Return the camera that a text asks for, fitted to the surface.

    Parameters
    ----------
    text : str
        One of `PRESETS`, or nine numbers "px,py,pz,fx,fy,fz,ux,uy,uz": position, focus, up; a
        tenth is half the height seen in a parallel view.
    triangles : Triangles
        What is to be seen.
    room : Room
        Of the picture; what is seen fills what is free.

    Raises
    ------
    CrossviewError
        The text is neither.
    """
    chosen = read_camera(text)
    if isinstance(chosen, Camera):
        return chosen
    away, up = _directions(chosen, triangles)
    parallel = chosen in _AXES or triangles.plane_normal is not None
    return (_fit_parallel if parallel else _fit)(triangles.points, away, up, room)


def read_camera(text: str) -> str | Camera:
    """Return the preset that a text names, or the camera that its nine numbers are.

    Raises
    ------
    CrossviewError
        The text is neither.
    """
    if text in PRESETS:
        return text
    try:
        numbers = [float(part) for part in text.split(",")]
    except ValueError:
        numbers = []
    tenth = len(numbers) == 10 and numbers[9] > 0.0
    if not (len(numbers) == 9 or tenth) or not (np.abs(numbers) < LARGEST).all():
        known = ", ".join(PRESETS)
        raise CrossviewError(
            f'no camera "{text}"', "camera", f"choose from {known}, or px,py,pz,fx,fy,fz,ux,uy,uz"
        )
    position, focus, upward = numbers[:3], numbers[3:6], numbers[6:9]
    if np.linalg.norm(np.cross(np.subtract(position, focus), upward)) == 0.0:
        raise CrossviewError(
            "the camera looks along its own up", "camera", "choose another up or position"
        )
    scale = numbers[9] if tenth else None
    return Camera(tuple(position), tuple(focus), tuple(upward), parallel_scale=scale)


def rows(matrix: vtkMatrix4x4) -> FloatArray:
    """Return a VTK matrix as an array (4, 4)."""
    return np.array([[matrix.GetElement(i, j) for j in range(4)] for i in range(4)])


def _directions(text: str, triangles: Triangles) -> tuple[FloatArray, FloatArray]:
    """Return the direction towards the eye and the one that is up."""
    x, y, z = np.eye(3)
    if text in _AXES:
        ahead = {"xy": (z, y), "xz": (-y, z), "yz": (x, z)}
        behind = {"yx": (-z, y), "zx": (y, z), "zy": (-x, z)}
        return (ahead | behind)[text]
    if text == "auto" and triangles.plane_normal is not None:
        normal = triangles.plane_normal
        return normal, (z if abs(normal[2]) < 0.9 else y)
    extents = np.ptp(triangles.points, axis=0)
    lying = extents.min() < _LYING * np.sort(extents)[1]
    up = np.eye(3)[int(np.argmin(extents))] if lying else y
    if abs(up[2]) == 1.0:
        side, front = x, -y
    elif abs(up[1]) == 1.0:
        side, front = x, z
    else:
        side, front = y, z
    if lying:
        return 0.3 * side + front + 1.15 * up, up
    return 0.55 * side + front + 0.45 * up, up


def _frame(away: FloatArray, up: FloatArray) -> FloatArray:
    """Rows: to the right, up in the picture, towards the eye."""
    back = away / np.linalg.norm(away)
    right = np.cross(up, back)
    right /= np.linalg.norm(right)
    return np.stack([right, np.cross(back, right), back])


def _fit(points: FloatArray, away: FloatArray, up: FloatArray, room: Room) -> Camera:
    """Perspective: the nearest eye, and its place sideways, that see all within the room."""
    frame = _frame(away, up)
    origin = points.mean(axis=0)
    seen = (points - origin) @ frame.T
    tan = np.tan(np.radians(VIEW_ANGLE) / 2.0)
    # The free part as slopes from the eye: centre and half size, per direction.
    half = np.array([tan * room.width / room.height, tan])
    free = _free(room)
    centre, size = free[:, 0] * half, free[:, 1] * half
    # |x_i - c_x - centre (d - z_i)| <= size (d - z_i) for all i, least d: a pair of cones.
    reach = np.stack(
        [seen[:, :2] + (centre + size) * seen[:, 2:], -seen[:, :2] + (size - centre) * seen[:, 2:]]
    )
    high, low = reach[0].max(axis=0), reach[1].max(axis=0)
    distance = float(((high + low) / (2.0 * size)).max())
    middle = (high - low) / 2.0 - centre * distance
    for _ in range(4):  # Also in the middle where there is room to spare.
        slopes = (seen[:, :2] - middle) / (distance - seen[:, 2:]) - centre
        middle += 0.5 * (slopes.max(axis=0) + slopes.min(axis=0)) * distance
    eye = origin + np.array([middle[0], middle[1], distance]) @ frame
    target = origin + np.array([middle[0], middle[1], 0.0]) @ frame
    return Camera(tuple(eye), tuple(target), tuple(frame[1]))


def _fit_parallel(points: FloatArray, away: FloatArray, up: FloatArray, room: Room) -> Camera:
    frame = _frame(away, up)
    seen = points @ frame.T
    low, high = seen.min(axis=0), seen.max(axis=0)
    aspect = np.array([room.width / room.height, 1.0])
    free = _free(room)
    scale = float(((high - low)[:2] / (2.0 * free[:, 1] * aspect)).max())
    middle = (high + low)[:2] / 2.0 - scale * aspect * free[:, 0]
    target = np.array([middle[0], middle[1], (high[2] + low[2]) / 2.0])
    depth = float(np.linalg.norm(high - low)) or 1.0
    eye = target + np.array([0.0, 0.0, 2.0 * depth])
    return Camera(tuple(eye @ frame), tuple(target @ frame), tuple(frame[1]), parallel_scale=scale)


def _free(room: Room) -> FloatArray:
    """Rows x, y: centre and half size of the free part, in half sizes of the picture."""
    sizes = np.array([room.width, room.height])
    low, high = np.array([room.left, room.bottom]), np.array([room.right, room.top])
    kept = np.maximum(sizes - low - high, 0.3 * sizes)
    return np.stack([(low - high) / sizes, kept / sizes], axis=1)
