"""Numbers and words as the window shows them."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from crossview.view.values import FloatArray

THIN_SPACE = "\u2009"
"""Between groups of three digits."""

MINUS = "\u2212"
"""The sign of negative numbers."""


def count(number: int, noun: str, plural: str = "") -> str:
    """Return "1 face", "2 304 faces"."""
    word = noun if number == 1 else plural or noun + "s"
    return f"{grouped(number)} {word}"


def grouped(number: int) -> str:
    """Return an integer with thin spaces between groups of three digits."""
    return f"{number:,}".replace(",", THIN_SPACE)


def signed(number: float, digits: int = 0) -> str:
    """Return "+1", "0" or "−2" with a true minus."""
    text = f"{number:+.{digits}f}"
    if float(text) == 0.0:
        return f"{0:.{digits}f}"
    return text.replace("-", MINUS)


def degrees(value: float) -> str:
    """Return an angle in degrees with the digits that matter near zero."""
    if abs(value) < 5e-4:
        return "0°"
    digits = 3 if abs(value) < 0.1 else 2 if abs(value) < 1.0 else 1
    return signed(value, digits).lstrip("+") + "°"


def position(coordinates: Sequence[float], size: float) -> str:
    """Return "0.31, −0.22, 1.00": as exact as tells places on a surface of this size apart."""
    digits = 4 if size < 0.1 else 2 if size < 100.0 else 0
    return ", ".join(signed(x, digits).lstrip("+") for x in coordinates)


def energy(value: float) -> str:
    """Return an integrability error with two digits, as "1.7" or "5.1e−04"."""
    text = f"{value:.2g}" if 0.01 <= value < 100.0 else f"{value:.1e}"
    return text.replace("-", MINUS)


def energies(values: Sequence[float]) -> str:
    """Return how E went: "E 1.7 → 1.8e−14 in 9 steps"."""
    if len(values) == 1:
        return f"E = {energy(values[0])}"
    return f"E {energy(values[0])} → {energy(values[-1])} in {count(len(values) - 1, 'step')}"


def measured(places: FloatArray, paths: Sequence[FloatArray]) -> str:
    """Return what is measured between places (k, 3) along paths (n, 3), or what to do for that."""
    if len(places) < 2:
        where = "to" if len(places) else "from"
        return f"Measure: click where {where}"
    if len(paths) < len(places) - 1:
        return "Measuring\u2026"
    along = float(np.linalg.norm(np.diff(paths[-1], axis=0), axis=1).sum())
    straight = math.dist(places[-2], places[-1])
    text = f"{along:.4g} along the surface, {straight:.4g} straight"
    if len(paths) < 2 or min(map(len, paths)) < 2:
        return text
    back, onward = paths[0][-2] - paths[0][-1], paths[1][1] - paths[1][0]
    turn = math.atan2(float(np.linalg.norm(np.cross(back, onward))), float(back @ onward))
    return f"{text}, at an angle of {degrees(math.degrees(turn))}"


def aspect(log_aspect: float) -> str:
    """Return how stretched the most stretched quads are."""
    ratio = math.exp(log_aspect)
    if ratio < 1.01:
        return "All quads are square."
    return f"Quads are up to {ratio:.{0 if ratio >= 9.95 else 1}f} times longer than wide."


def hover(H: float | None, triangle: int) -> str:
    """Return the status bar's read-out of what is under the mouse."""
    text = f"triangle {grouped(triangle)}"
    return text if H is None else f"H = {H:.3f}   {text}".replace("-", MINUS)
