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

TORUS_TURNS = Theorem(
    "Two singularities of a torus, of indices k and -k, are not possible where the turns around "
    "the handles are all multiples of k: the two would be one point",
    "Abel's theorem; for k = 2 Masur and Smillie 1993",
)
"""sum k_i z_i = 0 says k (z_1 - z_2) = 0; the turns tell the order of z_1 - z_2. From theory."""

CLOSED_TURNS = Theorem(
    "With only half turns around the handles of genus 2 there is neither a valence 12 alone nor "
    "valences 6 and 10 alone: the strata Q(4) and Q(3, 1) are empty",
    "Masur and Smillie 1993",
)
"""A field of half turns is a quadratic differential. From theory."""

SPIN = Theorem(
    "With whole turns around the handles of genus 2 a valence 12 alone has turns of odd spin only: "
    "the stratum H(2) is connected",
    "Kontsevich and Zorich 2003",
)
"""A field of whole turns is an abelian differential. From theory."""

ONE_WAY = Theorem(
    "With such turns the sides of the boundary do not close up: some run along a direction of the "
    "crosses and none against it",
    "Stokes' theorem",
)
"""Where all turns around closed loops are whole, u and v are closed 1-forms. From theory."""
