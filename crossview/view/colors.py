"""Every colour that means something, in one place."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
from cmcrameri import cm
from matplotlib.colors import ListedColormap, to_rgb

Rgb = tuple[float, float, float]

VALENCE = {
    1: "#5b2fa8",
    2: "#12a3b4",
    3: "#2f6fde",
    4: "#8a8f98",
    5: "#d93a3a",
    6: "#f08c1a",
    7: "#9c5a21",
    8: "#e8c51c",
    9: "#a4c639",
    10: "#62ab3c",
    11: "#2f8f4e",
    12: "#1b6b52",
}
"""Of singularities: cool for cones (fewer than four quads), warm for saddles, then greens.

3, 5, 6 and 8 as in the paper.
"""

GOOD, BAD, UNSURE, WAITING = "#2f9e5b", "#d93a3a", "#e0a01b", "#a9adb5"
"""Of verdicts."""
SURFACE = "#dcdee2"
"""Of a surface without a scalar."""

CROSS = "#1b1e24"
"""Of crosses."""

NEAR_MISS = "#1c1c1c"
"""Of separatrices that nearly meet a singularity."""

CUT = "#1f5fd6"
"""Of the cut graph."""

CUT_HALO = "#ffffff"
"""Around the cut graph."""

FEATURE = "#7a3db8"
"""Of features."""

LOOP = "#b0207a"
"""Of handle loops."""

CONDITIONS = (
    "#b0207a",
    "#0f6a9a",
    "#7a5c00",
    "#2c3e80",
    "#e07bb8",
    "#37474f",
    "#5fb3c8",
    "#8d6e63",
)
"""One for each holonomy condition in turn, none a valence's and none green as what is good."""

PROBLEM = "#e5182b"
"""Of what is wrong with a surface."""

SEPARATRIX = "#5c626c"
"""Of a curve that leaves no singularity."""
QUAD_EDGE = "#3a3f47"
"""Of the edges of quads."""

MARK_PAPER, MARK_INK, MARK_WARNING = "#ffffff", "#111317", "#d4141f"
"""Of signs: the ground, what is written, and a warning."""

PATCHES = (
    "#b9d3ea", "#f3d3b8", "#c7e0bd", "#dfcbe8", "#f2e6ae", "#bfe0dd", "#f0c6cd", "#d5d0c4",
)  # fmt: skip
"""Calm, and told apart by the eye also where colours are hard to tell."""

COLOR_MAPS = {
    "vik": cm.vik,
    "broc": cm.broc,
    "cork": cm.cork,
    "roma": cm.roma_r,
    "romaO": cm.romaO,
    "vikO": cm.vikO,
    "corkO": cm.corkO,
    "lajolla": cm.lajolla_r,
    "lajolla down": cm.lajolla,
}
"""Colour maps by name, those of Crameri 2018: even to the eye, also where colours are hard to tell.
"""

DIVERGING = ("vik", "broc", "cork", "roma")
"""Those for scalars about zero."""

CYCLIC = ("romaO", "vikO", "corkO")
"""Those for angles."""

_DARK_ENDS = dict.fromkeys(DIVERGING, (0.07, 0.07)) | {
    "lajolla": (0.0, 0.32),
    "lajolla down": (0.32, 0.0),
}
"""Shares of a map's two ends that are too dark to see crosses on, and left out. Chosen."""


@dataclass(frozen=True)
class Theme:
    """What depends on the background: its colour, the ink of text and boundaries, faint ink."""

    background: str
    ink: str
    text: str
    faint: str


THEMES = {
    "white": Theme("#ffffff", "#000000", "#22262c", "#8a8f98"),
    "dark": Theme("#1d2026", "#08090b", "#e6e8eb", "#8a8f98"),
}
"""Backgrounds by name."""


def rgb(color: str) -> Rgb:
    """Return the three parts, 0 to 1, of a colour's name."""
    red, green, blue = to_rgb(color)
    return float(red), float(green), float(blue)


def condition_color(condition: int) -> str:
    """Return the colour of a holonomy condition: of its loop, row and guide lines."""
    return CONDITIONS[condition % len(CONDITIONS)]


def valence_color(valence: int) -> str:
    """Return the colour ``#rrggbb`` of a singularity of this valence (above 12: as 12)."""
    return VALENCE[min(max(valence, 1), max(VALENCE))]


def color_table(name: str, over: float = 1.0, size: int = 256) -> npt.NDArray[np.uint8]:
    """Return a colour map as RGBA rows, laid with opacity `over` on the surface's grey.

    Parameters
    ----------
    name : str
        A key of `COLOR_MAPS`.
    over : float
        1: the map itself; 0: all grey.
    size : int
        Number of rows.

    Returns
    -------
    (size, 4) uint8
    """
    color_map: ListedColormap = COLOR_MAPS[name]
    # Ends are near black in the diverging and sequential maps: dark lines would be lost on them.
    low, high = _DARK_ENDS.get(name, (0.0, 0.0))
    table: npt.NDArray[Any] = np.asarray(color_map(np.linspace(low, 1.0 - high, size)))
    table[:, :3] = over * table[:, :3] + (1.0 - over) * np.array(rgb(SURFACE))
    return np.round(255.0 * table).astype(np.uint8)


def bytes_of(colors: list[str]) -> npt.NDArray[Any]:
    """Return the colours as rows of red, green, blue, 0 to 255."""
    return np.round(255.0 * np.array([rgb(color) for color in colors])).astype(np.uint8)
