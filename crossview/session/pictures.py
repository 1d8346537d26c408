"""From the state of a session to what a scene or a figure shows: pure functions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from crossview.session.document import Document
from crossview.session.hand import Focus, SelectTool
from crossview.session.held_ranges import NO_RANGES, Ranges
from crossview.session.state import SessionState
from crossview.view.colors import condition_color
from crossview.view.field import feature_lines, field_view, markers_of
from crossview.view.meshes import (
    curves_of,
    near_misses_of,
    patches_of,
    quads_of,
    t_junctions_of,
    triangles_of,
    worst_of,
)
from crossview.view.scalars import SURFACE_SCALARS
from crossview.view.scene_view import Background, LayerSettings, SceneView
from crossview.view.texts import measured
from crossview.view.values import Elements, Marker, Measurement
from solvers.fields import CrossField
from solvers.surface import IntArray, TriSurface

PALE = 0.3
"""What is left of the opacity of a field that is no longer that of the configuration. Chosen."""

POOR_QUALITY = 0.1
"""`TriSurface.triangle_quality` below which triangles are shown as poor. Chosen."""


def scene_view(state: SessionState, held: Ranges = NO_RANGES) -> SceneView:
    """Return what to draw.

    Parameters
    ----------
    state : SessionState
    held : mapping of str to (float, float)
        Colour ranges to keep by layer, so that colours do not jump while something is dragged or
        the method is changed.
    """
    surface, document = state.shown_surface, state.document
    background: Background = "dark" if state.dark else "white"
    if state.faulty is not None:
        faulty = state.faulty
        return SceneView(
            faulty.vertices,
            faulty.faces,
            problem=faulty.elements,
            background=background,
            layers=state.layers,
        )
    if surface is None or document is None:
        return SceneView(background=background, layers=state.layers)
    field = state.field if state.field is not None and state.field.surface is surface else None
    condition = state.focus.condition
    locked = [i for i, s in enumerate(state.singularities) if s.locked]
    markers = markers_of(document.surface, state.singularities, state.focus.all, locked)
    if field is None:
        view = SceneView(surface.vertices, surface.faces)
    else:
        view = _with_meshes(field_view(field, state.cut_graph), state)
        start = _start(state)
        if state.comparing and start is not None:
            view = replace(view, error_density=start.error_density)
    return replace(
        _with_features(view, state),
        triangles=triangles_of(surface),
        singularities=markers,
        preview=_preview(state, surface),
        loop=_loop(state),
        loop_color="" if condition is None else condition_color(condition),
        guide=state.guide,
        near_misses=None if state.near_misses is None else near_misses_of(state.near_misses),
        clip=state.clip,
        measurement=_measurement(state, document.surface),
        problem=Elements(faces=poor_faces(surface)) if state.poor else state.pointed,
        title=_title(state, document),
        background=background,
        layers=_dimmed(_layers(state.layers, held)) if state.stale else _layers(state.layers, held),
    )


def _with_meshes(view: SceneView, state: SessionState) -> SceneView:
    """Return the view with what has been made of the field."""
    made, separatrices = state.made, state.separatrices
    if separatrices is not None:
        view = replace(view, separatrices=curves_of(separatrices))
        if made.settled:  # in a drag curves are cut for speed
            view = replace(view, t_junctions=t_junctions_of(separatrices))
    return replace(
        view,
        misaligned=made.misaligned,
        layout=None if made.layout is None else patches_of(made.layout),
        quads=None if made.quads is None else quads_of(made.quads),
        worst=None if made.quads is None else worst_of(made.quads),
    )


def _with_features(view: SceneView, state: SessionState) -> SceneView:
    """Return the view with the feature edges."""
    features = state.features
    if features is None:
        return view
    field = None if state.feature_trial is not None else state.field_along_features
    lines: Mapping[str, Any] = feature_lines(features, field, state.tolerance)
    return replace(view, **lines)


def poor_faces(surface: TriSurface) -> IntArray:
    """Return the numbers of the triangles that are poor for finite elements."""
    return np.flatnonzero(surface.triangle_quality < POOR_QUALITY)


def figure_view(state: SessionState, transparent: bool, held: Ranges = NO_RANGES) -> SceneView:
    """Return what to draw in a figure: what is shown, without what only helps to edit."""
    plain = replace(
        state,
        trial=None,
        focus=Focus(),
        guide=(),
        near_misses=None,
        clip=None,
        poor=False,
        tool=SelectTool(),
    )
    view = replace(scene_view(plain, held), worst=None)
    unlocked = tuple(replace(marker, locked=False) for marker in view.singularities)
    view = replace(view, singularities=unlocked)
    return replace(view, transparent=transparent)


def _preview(state: SessionState, surface: TriSurface) -> Marker | None:
    trial = state.trial
    if trial is None or trial.drag or trial.surface is not surface:
        return None
    (marker,) = markers_of(surface, [replace(trial.held, point=trial.placed)])
    return marker


def _measurement(state: SessionState, surface: TriSurface) -> Measurement | None:
    tool = state.measure_tool
    if tool is None:
        return None
    places = surface.positions(tool.places).reshape(-1, 3)
    return Measurement(places, tool.paths, measured(places, tool.paths))


def _loop(state: SessionState) -> IntArray | None:
    if state.mark_tool is not None:
        return state.mark_tool.path
    condition = state.focus.condition
    if state.base is None or condition is None:
        return None
    return state.base.solver.holonomy.conditions[condition].path


def _title(state: SessionState, document: Document) -> str:
    title = document.title or document.name
    shown = state.comparing and state.layers["error"].visible and _start(state) is not None
    return f"Error at the start \u2013 {title}" if shown else title


def _start(state: SessionState) -> CrossField | None:
    """Return the start if it can be compared with the field shown."""
    start, field = state.start, state.field
    return start if start and field and start.surface is field.surface else None


def _layers(layers: Mapping[str, LayerSettings], held: Ranges) -> Mapping[str, LayerSettings]:
    kept = {
        name: replace(layers[name], value_range=limits)
        for name, limits in held.items()
        if layers[name].value_range is None
    }
    return {**layers, **kept}


def _dimmed(layers: Mapping[str, LayerSettings]) -> Mapping[str, LayerSettings]:
    """Return the layers with what is drawn of the field pale."""
    pale = {
        name: replace(layers[name], opacity=PALE * layers[name].opacity)
        for name in (*SURFACE_SCALARS, "crosses", "separatrices")
    }
    return {**layers, **pale}
