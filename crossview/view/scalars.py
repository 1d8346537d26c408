"""What may colour the surface: the scalars, their colour maps, limits and words."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from crossview.view.field import cross_angle
from crossview.view.geometry import FloatArray, Triangles
from crossview.view.scene_view import LayerSettings, SceneView

Limits = tuple[float, float]

Beyond = tuple[bool, bool]
"""Whether values are below limits, and whether above."""

WITHIN: Beyond = (False, False)
"""None are."""

_SLACK = 1e-6
"""Of the range, that values may be beyond a limit by rounding. Chosen."""

_LEAST_LIMIT = 0.01
"""Least range of colours, in the scalar's unit.

Chosen: sizes that differ by less than a percent are not worth a colour.
"""

_DECADES, _ROUNDING = 4.0, -10.0
"""Decades of the error density told apart, and the highest of them where all is rounding. Chosen.
"""

_STEPS = np.array([1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0])
"""Numbers that a range of colours ends at, times a power of ten. Chosen."""

_QUALITY_STEP = 0.05
"""The least scaled Jacobian of a range is a multiple of this. Chosen."""

_SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
"""Digits as they stand in exponents."""


@dataclass(frozen=True)
class ScalarKind:
    """A scalar's own colour map, its title, and whether it has one value for each triangle."""

    color_map: str
    title: str
    cells: bool


SCALARS = {
    "error": ScalarKind("lajolla", "error", cells=True),
    "theta": ScalarKind("romaO", "θ", cells=True),
    "aspect": ScalarKind("lajolla", "aspect", cells=True),
    "H1": ScalarKind("vik", "H₁", cells=True),
    "H2": ScalarKind("vik", "H₂", cells=True),
    "H": ScalarKind("vik", "H", cells=False),
    "quads": ScalarKind("lajolla down", "scaled Jacobian", cells=True),
}
"""By the name of their layer; of several that are visible the first is shown."""

SURFACE_SCALARS = tuple(name for name in SCALARS if name != "quads")
"""Those that colour the triangles: in the window one of them at a time."""


def shown_scalar(view: SceneView) -> str:
    """Return which scalar colours the surface or the quads in its place, "" for none."""
    if view.cover:
        quality = view.cover == "quads" and view.layer("quads").coloring == "quality"
        return "quads" if quality else ""
    sizes = view.H is not None and view.half_log_aspect is not None
    there = {
        "error": view.error_density is not None,
        "theta": view.u is not None,
        "H": view.H is not None,
        "quads": False,
    }
    for name in SCALARS:
        if view.layer(name).visible and there.get(name, sizes):
            return name
    return ""


def scalar_values(view: SceneView, name: str, triangles: Triangles) -> FloatArray | None:
    """Return the values of a scalar, (n,) or (m,) by its kind; of the error the logarithm to 10."""
    if name == "H":
        return view.H
    if name == "theta":
        return None if view.u is None else cross_angle(triangles, view.u)
    if name == "error":
        density = view.error_density
        return None if density is None else np.log10(np.maximum(density, 1e-300))
    if view.H is None or view.half_log_aspect is None:
        return None
    mean, half = view.H[triangles.faces].mean(axis=1), view.half_log_aspect.mean(axis=1)
    return np.asarray({"aspect": np.abs(2.0 * half), "H1": mean - half, "H2": mean + half}[name])


def scalar_limits(view: SceneView, name: str, triangles: Triangles, values: FloatArray) -> Limits:
    """Return the limits of a scalar's colours: those of its layer, else fitted to its values."""
    given = view.layer(name).value_range
    if name == "theta":
        return (0.0, np.pi / 2)
    if given is not None:
        return given
    if name == "error":
        return _decades(values, triangles.areas)
    if name == "aspect":
        return (0.0, _rounded_up(max(_bulk(values, triangles.areas), _LEAST_LIMIT)))
    if name == "H":
        return symmetric_range(values, triangles.vertex_areas)
    # one range for both
    sizes = [scalar_values(view, each, triangles) for each in ("H1", "H2")]
    both = np.concatenate([each for each in sizes if each is not None])
    return symmetric_range(both, np.tile(triangles.areas, 2))


def quality_limits(settings: LayerSettings, quality: FloatArray) -> Limits:
    """Return the limits of the colours of quads: unless given, from what 98 % are above, to 1."""
    if settings.value_range is not None:
        return settings.value_range
    low = float(np.floor(np.quantile(quality, 0.02) / _QUALITY_STEP)) * _QUALITY_STEP
    return (min(low, 1.0 - _QUALITY_STEP), 1.0)


def density_limits(density: FloatArray, areas: FloatArray) -> Limits:
    """Return the limits, powers of 10, that the colours of an error density are fitted to."""
    return _decades(np.log10(np.maximum(density, 1e-300)), areas)


def symmetric_range(values: FloatArray, weights: FloatArray) -> Limits:
    """Return round limits about 0 that leave out the far ends at the singularities.

    H has a logarithm's pole at each singularity, as deep as the mesh there is fine. So the limit
    is what 98 % of the area stay below, rounded up to one or two digits.

    Parameters
    ----------
    values : (n,) float
    weights : (n,) float
        Area about each value.
    """
    limit = _rounded_up(max(_bulk(np.abs(values), weights), _LEAST_LIMIT))
    return (-limit, limit)


def beyond(values: FloatArray, limits: Limits) -> Beyond:
    """Return whether some values are below limits, and whether some are above."""
    slack = _SLACK * (limits[1] - limits[0])
    return bool(values.min() < limits[0] - slack), bool(values.max() > limits[1] + slack)


def bar_texts(name: str, limits: Limits, beyond: Beyond = WITHIN) -> list[str]:
    """Return the five numbers beside the colour bar, from its foot up; `beyond` marks the ends."""
    if name == "theta":
        return ["0°", "", "45°", "", "90°"]
    texts = _numbers(name, limits)
    below, above = beyond
    texts[0] = f"≤ {texts[0]}" if below else texts[0]
    texts[-1] = f"≥ {texts[-1]}" if above else texts[-1]
    return texts


def _numbers(name: str, limits: Limits) -> list[str]:
    """Return the five numbers beside the colour bar."""
    values = np.linspace(*limits, 5)
    if name == "error":
        whole = [float(value).is_integer() for value in values]
        powers = ["10" + f"{value:.0f}".translate(_SUPERSCRIPTS) for value in values]
        return [power if shown else "" for power, shown in zip(powers, whole, strict=True)]
    step = (limits[1] - limits[0]) / 4.0
    digits = max(0, 1 - int(np.floor(np.log10(step)))) if step > 0.0 else 1
    texts = [f"{value:.{digits}f}" for value in values]
    return [text.replace("-", "−") if float(text) else "0" for text in texts]


def _decades(logarithms: FloatArray, areas: FloatArray) -> Limits:
    top = max(float(np.ceil(_bulk(logarithms, areas))), _ROUNDING)
    return (top - _DECADES, top)


def _bulk(values: FloatArray, weights: FloatArray) -> float:
    """Return what the values on 98 % of the area stay below."""
    order = np.argsort(values)
    share = np.cumsum(weights[order])
    return float(values[order][np.searchsorted(share, 0.98 * share[-1])])


def _rounded_up(top: float) -> float:
    steps = _STEPS * 10.0 ** np.floor(np.log10(top))
    return float(steps[np.searchsorted(steps, top * (1.0 - 1e-9))])
