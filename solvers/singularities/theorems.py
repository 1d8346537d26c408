"""Theorems that forbid quad meshes."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Theorem:
    """What forbids a quad mesh: the statement, and whose it is.

    Parameters
    ----------
    statement : str
        What it says, in a sentence without full stop.
    source : str
        Where it is proved.

    Examples
    --------
    >>> from solvers.singularities.theorems import TORUS_PAIR
    >>> TORUS_PAIR.source
    'Barnette, Jucovic and Trenkler 1973; Izmestiev et al. 2013'
    """

    statement: str
    source: str

    def __str__(self) -> str:
        """Return both, in a sentence."""
        return f"{self.statement} ({self.source})."


BUDGET = Theorem(
    "The indices of singularities and corners sum to four times the Euler characteristic",
    "Gauss and Bonnet; Poincare and Hopf",
)
"""The index budget. From theory."""

TORUS_PAIR = Theorem(
    "No quadrangulation of a torus has one valence 3, one valence 5 and nothing else",
    "Barnette, Jucovic and Trenkler 1973; Izmestiev et al. 2013",
)
"""By Abel's theorem too: two points that differ by a period are one. From theory."""

FLAT_TORUS = Theorem(
    "On a torus without singularities the crosses turn around no handle",
    "the holonomy of a flat torus",
)
"""A flat torus is the plane by translations. From theory."""

FLAT_ANNULUS = Theorem(
    "Between two straight boundaries without singularities the crosses do not turn",
    "developing the boundaries",
)
"""A flat annulus with straight boundaries is a cylinder. From theory."""

ZIGZAG = Theorem(
    "Corners that turn to and fro shift a boundary off its line, which a straight boundary "
    "opposite does not allow without singularities",
    "developing the boundaries",
)
"""See `solvers.singularities.topology.decide`. From theory."""

ANNULUS_TURNS = Theorem(
    "With such turns the two boundaries are displaced in different directions",
    "developing the boundaries",
)
"""See `solvers.singularities.topology.decide`. From theory."""

EMPTY_STRATUM = Theorem(
    "No quad mesh has two straight boundaries, corners of -3 and -1 on a third one and no "
    "singularity: its double would be in the empty stratum Q(3, 1)",
    "Masur and Smillie 1993",
)
"""All holonomy of the double is in half turns, so it is a quadratic differential. From theory."""
