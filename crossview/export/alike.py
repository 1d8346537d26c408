"""Several views with one camera and one range of colours, to be compared."""

from __future__ import annotations

from collections.abc import Sequence

from crossview.export.raster import pixel_ratio
from crossview.scene import Camera, SceneView
from crossview.scene.camera import camera_for, read_camera
from crossview.scene.scene import room_for
from crossview.view.geometry import Triangles
from crossview.view.scalars import (
    Beyond,
    Limits,
    beyond,
    quality_limits,
    scalar_limits,
    scalar_values,
    shown_scalar,
)


def with_one_range(views: Sequence[SceneView]) -> list[SceneView]:
    """Return the views with the colours of each scalar over all values that occur.

    Parameters
    ----------
    views : sequence of SceneView
    """
    limits: dict[str, Limits] = {}
    for view in views:
        name, own = shown_scalar(view), shown_limits(view)
        if own is not None and name != "theta":  # an angle has one range anyway
            low, high = limits.get(name, own[0])
            limits[name] = (min(low, own[0][0]), max(high, own[0][1]))
    return [
        view.with_layer(name, value_range=limits[name])
        if (name := shown_scalar(view)) in limits
        else view
        for view in views
    ]


def shown_limits(view: SceneView) -> tuple[Limits, Beyond] | None:
    """Return the limits of the colours of what a view shows, and whether values are beyond.

    None where they show no scalar.
    """
    name = shown_scalar(view)
    if name == "quads":
        mesh = view.quads
        if mesh is None or mesh.quality is None:
            return None
        limits = quality_limits(view.layer(name), mesh.quality)
        return limits, beyond(mesh.quality, limits)
    if not name or view.points is None or view.faces is None:
        return None
    triangles = Triangles(view.points, view.faces)
    values = scalar_values(view, name, triangles)
    if values is None:
        return None
    limits = scalar_limits(view, name, triangles, values)
    return limits, beyond(values, limits)


def one_camera(views: Sequence[SceneView], size: tuple[int, int], camera: str | Camera) -> Camera:
    """Return the camera that shows the first of the views, for all of them.

    Parameters
    ----------
    views : sequence of SceneView
    size : (int, int)
        Of each picture.
    camera : str or Camera
        As of `figures.render_view`.
    """
    view = views[0]
    chosen = read_camera(camera) if isinstance(camera, str) else camera
    if isinstance(chosen, Camera):
        return chosen
    if view.points is None or view.faces is None:
        raise ValueError("there is no surface to look at")
    triangles = Triangles(view.points, view.faces)
    return camera_for(chosen, triangles, room_for(view, size, pixel_ratio(size)))
