"""What things in space are drawn on, as vectors: lines, discs and signs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from crossview.view.geometry import FloatArray


class Easel(Protocol):
    """A sheet of paper, or a page that turns."""

    def lines(
        self,
        segments: FloatArray,
        color: str,
        width: float,
        towards: float,
        opacity: float = 1.0,
        *,
        round_ends: bool = False,
    ) -> None:
        """Draw segments (k, 2, 3), their width in pixels of the window, `towards` the eye."""

    def discs(
        self,
        centres: FloatArray,
        radius: float,
        towards: float,
        colors: Sequence[Sequence[str]],
        parts: Sequence[float],
    ) -> None:
        """Draw discs in space that face the eye, each of several parts from the rim inwards.

        Parameters
        ----------
        centres : (k, 3) float
        radius : float
            In space.
        towards : float
        colors : k sequences of str
            For each disc a colour per part.
        parts : sequence of float
            Radius of each part as a share of the disc's.
        """

    def signs(
        self,
        places: FloatArray,
        diameter: float,
        towards: float,
        strokes: Sequence[Sequence[float]],
        paints: tuple[str, str],
        rim: float,
    ) -> None:
        """Draw signs, of one size at every distance, at places in space.

        Parameters
        ----------
        places : (k, 3) float
        diameter : float
            In pixels of the window.
        towards : float
        strokes : sequence of (left, low, right, high)
            Boxes of its letter, in diameters from its centre.
        paints : (str, str)
            Ink and paper.
        rim : float
            Width of the rim, in diameters.
        """
