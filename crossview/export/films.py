"""What the pictures of an animation show, one after the other."""

from __future__ import annotations

from collections.abc import Generator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from crossview.scene import Camera
from crossview.scene.camera import VIEW_ANGLE
from crossview.view.geometry import Triangles
from crossview.workflow import configurations
from crossview.workflow.pipeline import Pipeline
from crossview.workflow.problem import Problem
from crossview.workflow.solution import Solution
from solvers.errors import CrossviewError
from solvers.fields import FieldStep
from solvers.progress import Progress, between, relayed
from solvers.singularities import Singularity
from solvers.surface import SurfacePoint
from solvers.validity import Moved

Solving = Generator[Progress, None, list[Solution]]

MOST_STEPS = 40
"""Of a way to validity that are solved and shown, evenly chosen, the first and the last with them.
"""

ROOM, TILT = 1.08, np.radians(40.0)
"""Around a surface that turns, as a share of it; from which height a plane is seen. Chosen."""

Place = tuple[float, float, float]


@dataclass(frozen=True)
class Drag:
    """A way that one singularity takes.

    Parameters
    ----------
    number : int
        Which, from 1 on as everywhere that users read.
    places : sequence of (x, y, z)
        Where it passes, after where it is; straight in between, then onto the surface.
    frames : int
        Pictures of the whole way.
    """

    number: int
    places: Sequence[Place]
    frames: int


def turntable(
    camera: Camera, triangles: Triangles, size: tuple[int, int], frames: int
) -> list[Camera]:
    """Return cameras once around a surface, in even steps, that see all of it from every side.

    They turn about the axis of space that is up for the first, around a plane about its normal.

    Parameters
    ----------
    camera : Camera
        The first, whose side and projection are kept.
    triangles : Triangles
        What is seen.
    size : (int, int)
        Of the pictures.
    frames : int
        How many.
    """
    low, high = triangles.points.min(axis=0), triangles.points.max(axis=0)
    pivot = (low + high) / 2.0
    radius = ROOM * float(np.linalg.norm(triangles.points - pivot, axis=1).max())
    up = np.array(camera.up) / np.linalg.norm(camera.up)
    side = np.subtract(camera.position, camera.focus)
    side = side / np.linalg.norm(side)
    normal = triangles.plane_normal
    if normal is None:
        axes = np.concatenate([np.eye(3), -np.eye(3)])
        axis = axes[np.argmax(axes @ (up + 0.5 * side))]  # seen from above it leans to the eye
    else:
        axis = normal * (np.sign(normal @ side) or 1.0)
        side = np.sin(TILT) * axis - np.cos(TILT) * (up - (up @ axis) * axis)
    narrow = min(1.0, size[0] / size[1])
    tan = np.tan(np.radians(VIEW_ANGLE) / 2.0) * narrow
    away = side * radius * np.sqrt(1.0 + 1.0 / tan**2)
    turned = []
    for angle in 2.0 * np.pi * np.arange(frames) / frames:
        cos, sin = np.cos(angle), np.sin(angle)
        along = axis * (axis @ away) * (1.0 - cos)
        position = pivot + cos * away + sin * np.cross(axis, away) + along
        half = None if camera.parallel_scale is None else radius / narrow
        turned.append(Camera(tuple(position), tuple(pivot), tuple(axis), parallel_scale=half))
    return turned


def still(problem: Problem) -> Solving:
    """Solve a problem.

    Raises
    ------
    CrossviewError
        As `Pipeline.solve`.
    """
    return [(yield from Pipeline().solve(problem))]


def iterations(problem: Problem) -> Solving:
    """Solve by a method that iterates, and keep every iterate.

    Raises
    ------
    CrossviewError
        The method does not iterate, or the problem cannot be solved.
    """
    if problem.method not in ("anisotropic", "alternating"):
        raise CrossviewError(
            f"the method {problem.method} does not iterate", "", "--method anisotropic does"
        )
    pipeline, found = Pipeline(), []

    def keep(step: Progress) -> Progress:
        if isinstance(step, FieldStep):
            found.append(pipeline.so_far(step))
        return step

    last = yield from relayed(pipeline.solve(problem), keep)
    return [*found, last]


def way_to_validity(problem: Problem) -> Solving:
    """Move singularities until a configuration is valid, and solve it on the way.

    Raises
    ------
    CrossviewError
        As `configurations.make_valid`, or a configuration on the way cannot be solved.
    """
    placed = [problem.singularities]

    def keep(step: Progress) -> Progress:
        if isinstance(step, Moved):
            placed.append(step.singularities)
        return step

    moving = relayed(configurations.make_valid(problem), keep)
    end, _ = yield from between(moving, 0.0, 0.5)
    placed.append(end.singularities)
    chosen = np.unique(np.round(np.linspace(0, len(placed) - 1, MOST_STEPS)).astype(int))
    return (yield from _solved(problem, [placed[number] for number in chosen]))


def dragged(problem: Problem, drag: Drag) -> Solving:
    """Solve with one singularity on its way.

    Raises
    ------
    CrossviewError
        There is no such singularity, or a configuration on the way cannot be solved.
    """
    surface, placed = problem.surface, problem.singularities
    if not 1 <= drag.number <= len(placed):
        raise CrossviewError(
            f"there is no singularity {drag.number}", f"of {len(placed)}", "they count from 1 on"
        )
    which = drag.number - 1
    corners = np.array([surface.position(placed[which].point), *drag.places], float)
    lengths = np.linalg.norm(np.diff(corners, axis=0), axis=1)
    reached = np.concatenate([[0.0], np.cumsum(lengths)])
    at = np.linspace(0.0, reached[-1], drag.frames)
    places = np.stack([np.interp(at, reached, corners[:, axis]) for axis in range(3)], axis=1)

    def moved(point: SurfacePoint) -> tuple[Singularity, ...]:
        return tuple(replace(s, point=point) if i == which else s for i, s in enumerate(placed))

    return (yield from _solved(problem, [moved(surface.closest_point(p)) for p in places]))


def _solved(problem: Problem, placed: Sequence[tuple[Singularity, ...]]) -> Solving:
    """Solve a problem with its singularities at several places."""
    pipeline, found = Pipeline(), []
    for number, singularities in enumerate(placed):
        first, last = (0.5 + 0.5 * n / len(placed) for n in (number, number + 1))
        solving = pipeline.solve(replace(problem, singularities=singularities, connections=()))
        found.append((yield from between(solving, first, last)))
    return found
