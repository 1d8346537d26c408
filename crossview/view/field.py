"""From the solvers' values to what the scene shows."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from functools import lru_cache
from typing import Any

import numpy as np

from crossview.view.geometry import FloatArray, IntArray, Triangles
from crossview.view.scene_view import SceneView
from crossview.view.values import Marker
from solvers.features import Features
from solvers.fields import CrossField, Limits
from solvers.singularities import Singularity
from solvers.surface import TriSurface


def field_view(field: CrossField, cut_graph: IntArray | None = None, **others: Any) -> SceneView:
    """Return the view of a solved field.

    Parameters
    ----------
    field : CrossField
    cut_graph : (k, 2) int, optional
        Vertex pairs of the field's surface.
    **others
        Further fields of `SceneView`: layers, title, background, ...
    """
    surface = field.surface
    markers = markers_of(surface, field.singularities)
    values = {"singularities": markers, **others}
    return SceneView(
        surface.vertices,
        surface.faces,
        H=field.H,
        half_log_aspect=field.half_log_aspect,
        error_density=field.error_density,
        u=field.u,
        v=field.v,
        cut_graph=cut_graph,
        **values,
    )


def markers_of(
    surface: TriSurface,
    singularities: Sequence[Singularity],
    selected: Collection[int] = (),
    locked: Collection[int] = (),
) -> tuple[Marker, ...]:
    """Return what to draw of singularities on a surface, some, by number, as selected or locked."""
    points = [s.point for s in singularities]
    positions = surface.positions(points).tolist()
    normals = surface.face_normals[np.array([point.face for point in points], int)].tolist()
    return tuple(
        Marker(tuple(position), s.valence, i in selected, i in locked, tuple(normal))
        for i, (s, position, normal) in enumerate(
            zip(singularities, positions, normals, strict=True)
        )
    )


@lru_cache(maxsize=4)
def feature_lines(
    features: Features, field: CrossField | None, tolerance_degrees: float
) -> Mapping[str, IntArray]:
    """Return the feature edges for a `SceneView`: all, and those that the crosses miss.

    The same arrays for the same features and field, for a scene tells arrays apart by identity.

    Parameters
    ----------
    features : Features
        On the surface that is shown.
    field : CrossField or None
        What is shown on it; None: nothing is missed.
    tolerance_degrees : float
        Angle from which a curve counts as missed.
    """
    lines: dict[str, IntArray] = {"features": features.ends}
    if field is not None and len(features):
        off = Limits(np.radians(tolerance_degrees)).missed(field.feature_misalignment)
        lines["missed"] = features.ends[off[features.curve_of]]
    return lines


def cross_angle(triangles: Triangles, u: FloatArray) -> FloatArray:
    """Angle of the crosses against a direction fixed in space, projected to each triangle.

    The direction is the axis least often normal to the surface (x on a surface seen from above):
    where it is normal the angle has a pole, of the reference and not of the field.

    Parameters
    ----------
    triangles : Triangles
    u : (m, 3) float

    Returns
    -------
    (m,) float
        Radians, in [0, pi/2): a cross is the same after a quarter turn.
    """
    normals = triangles.normals
    reference = np.eye(3)[int(np.argmin(triangles.areas @ normals**16))]
    along = np.einsum("ij,j->i", u, reference)
    across = np.einsum("ij,ij->i", np.cross(normals, u), np.broadcast_to(reference, u.shape))
    # reference = along u + across (n x u): the cross is turned back by this angle.
    return np.asarray(np.mod(-np.arctan2(across, along), np.pi / 2))
