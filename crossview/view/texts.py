"""Numbers and words as the window shows them."""

from __future__ import annotations

import math
from collections.abc import Sequence

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
