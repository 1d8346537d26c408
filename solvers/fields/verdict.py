"""Whether a field is what it seems: E near zero is not enough."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from solvers.algebra.factorization import RESIDUAL_BOUND
from solvers.fields.crossfield import CrossField
from solvers.fields.holonomy import Holonomy
from solvers.number_checks import real_number, whole_number
from solvers.remedies import ANISOTROPIC, MAKE_VALID, Remedy, in_words
from solvers.surface.triangulation import BoolArray, FloatArray

TOLERANCE_DEGREES = 0.01
"""Holonomy defects and misalignments below are none, unless a case says otherwise. Chosen."""

INTEGRABLE = 1e-8
"""E below which nothing but rounding is left. Chosen, far above what solves leave, some 1e-14."""

NEARLY_INTEGRABLE = 0.01
"""E up to which an aligned field is the isotropic one as far as the mesh can tell.

Chosen: a fifth of a degree of defect on an annulus. A configuration made valid for the Delaunay
operator has defects of some hundredths of a degree for that of the surface's own triangles.
"""

CLOSED = 1e-6
"""Largest angle, radians, by which neighbouring crosses fail to match for rounding alone.

Chosen: real surfaces reach 1e-9.
"""

EXTREME_ASPECT = 3.0
"""|H2 - H1| beyond which quads are too stretched to trust: twenty to one. Chosen."""

GROWTH = 1.2
"""Growth of int |grad s|^2 on a once refined mesh that tells a forced field, a factor.

Chosen between what was measured: 1.05 to 1.11 where a field is possible, 1.35 to 1.42 where not.
"""


@dataclass(frozen=True)
class Limits:
    """How far from perfect a field may be and be called valid; one for every judgement.

    Parameters
    ----------
    angle : float, optional
        Holonomy defects and misalignments are below, radians.
    energy : float, optional
        E is not above.

    Raises
    ------
    CrossviewError
        Unless the angle is a positive number and the energy one from 0.

    Examples
    --------
    >>> import numpy as np
    >>> from solvers.fields import Limits
    >>> Limits(angle=0.1).missed(np.array([-0.2, 0.05])).tolist()
    [True, False]
    """

    angle: float = float(np.radians(TOLERANCE_DEGREES))
    energy: float = INTEGRABLE

    def __post_init__(self) -> None:
        real_number("the angle of limits", self.angle, above=0)
        real_number("the energy of limits", self.energy, 0)

    @classmethod
    def on(cls, holonomy: Holonomy, angle: float) -> Limits:
        """Return the limits for a surface: E may be what defects below the angle leave.

        Parameters
        ----------
        holonomy : Holonomy
            Of the surface.
        angle : float
            As the parameter.
        """
        return cls(angle, max(INTEGRABLE, holonomy.aligned_energy(angle)))

    def missed(self, angles: FloatArray) -> BoolArray:
        """Return which angles (k,), radians, are not below the limit.

        Parameters
        ----------
        angles : (k,) float array
            Defects or misalignments, radians.
        """
        return np.asarray(~(np.abs(angles) < self.angle))


STRICT = Limits()
"""A hundredth of a degree, and E zero but for rounding."""


@dataclass(frozen=True)
class Verdict:
    """A judgement on a field.

    Parameters
    ----------
    status : {"valid", "suspect", "impossible", "unknown"}
        The judgement; "unknown" where the field is not solved well enough to be judged.
    reason : str
        Why, in a sentence.
    remedies : tuple of Remedy, optional
        What may be done about it.
    refused : bool, optional
        Whether no layout is made of such a field; never of a valid one.

    Examples
    --------
    >>> from solvers.fields import Verdict
    >>> verdict = Verdict("suspect", "1 triangle is inverted in the seamless map.")
    >>> print(verdict)
    1 triangle is inverted in the seamless map.
    """

    status: Literal["valid", "suspect", "impossible", "unknown"]
    reason: str
    remedies: tuple[Remedy, ...] = ()
    refused: bool = False

    def __str__(self) -> str:
        """Return the reason and what may be done, in a sentence."""
        if not self.remedies:
            return self.reason
        return f"{self.reason.rstrip('.')}; {in_words(self.remedies)}."


def judge(
    field: CrossField,
    inverted: int | None = None,
    growth: float | None = None,
    limits: Limits = STRICT,
) -> Verdict:
    """Judge a field by topology, closing, alignment, integrability, its map, aspect and growth.

    Parameters
    ----------
    field : CrossField
        What to judge.
    inverted : int, optional
        Inverted triangles in its seamless map; None where there is no such map.
    growth : float, optional
        int |grad s|^2 on a once refined mesh over that of the field.
    limits : Limits, optional
        What is valid.

    Returns
    -------
    Verdict
        With the first reason found not to trust the field.

    Raises
    ------
    CrossviewError
        Unless the number and the growth are numbers from 0.

    Notes
    -----
    That a torus with one valence 3 and one valence 5 has no quads: Izmestiev et al. 2013.

    Examples
    --------
    >>> from solvers.fields import IsotropicSolver, judge
    >>> from solvers.primitives import torus
    >>> from solvers.singularities import Singularity
    >>> surface = torus(n=24)
    >>> solver = IsotropicSolver(surface)
    >>> judge(solver.solve([])).status  # aligned with itself all around
    'valid'
    >>> places = [surface.closest_point([x, 0.0, 0.0]) for x in (1.4, -0.6)]
    >>> pair = [Singularity(places[0], valence=3), Singularity(places[1], valence=5)]
    >>> judge(solver.solve(pair)).status
    'impossible'
    """
    if inverted is not None:
        inverted = whole_number("the number of inverted triangles", inverted, 0)
    if growth is not None:
        growth = real_number("the growth", growth, 0)
    indices = sorted(s.index for s in field.singularities)
    surface = field.surface
    if surface.genus == 1 and not surface.boundary_loops and indices == [-1, 1]:
        return Verdict(
            "impossible",
            "No quadrangulation of a torus has one valence 3, one valence 5 and nothing else "
            "(Izmestiev et al. 2013).",
            refused=True,
        )
    if not field.residual <= RESIDUAL_BOUND:
        return Verdict(
            "unknown",
            f"Not known: the linear system is solved to a residual of {field.residual:.1g} only; "
            "look for triangles without area.",
            refused=True,
        )
    if not field.max_closing_error <= CLOSED:
        apart = np.degrees(field.max_closing_error)
        return Verdict(
            "unknown",
            f"Not known: crosses of two neighbouring triangles differ by {apart:.2g} degrees more "
            "than quarter turns.",
            refused=True,
        )
    return (
        _judge_alignment(field, limits)
        or _judge_integrability(field, limits)
        or _judge_quality(field, inverted, growth)
    )


def _judge_alignment(field: CrossField, limits: Limits) -> Verdict | None:
    both = (MAKE_VALID, ANISOTROPIC)
    if limits.missed(field.defects).any():
        worst = _worst(field.defects)
        reason = f"No isotropic field is aligned: a holonomy defect is {worst:.3g} degrees."
        return Verdict("impossible", reason, both, refused=True)
    if limits.missed(field.boundary_misalignment).any():
        off = _worst(field.boundary_misalignment)
        reason = f"The field is {off:.3g} degrees off a boundary."
        return Verdict("suspect", reason, both, refused=True)
    if limits.missed(field.feature_misalignment).any():
        off = _worst(field.feature_misalignment)
        reason = f"The field is {off:.3g} degrees off a feature curve."
        return Verdict("suspect", reason, (ANISOTROPIC,), refused=True)
    return None


def _judge_integrability(field: CrossField, limits: Limits) -> Verdict | None:
    if field.energy <= limits.energy:
        if field.convergence.converged:
            return None
        return Verdict("suspect", f"The iteration has not converged: E = {field.energy:.2g}.")
    reason = f"The field is aligned but not integrable: E = {field.energy:.2g}."
    if field.energy <= NEARLY_INTEGRABLE:
        return Verdict("suspect", reason)
    return Verdict("suspect", reason, (MAKE_VALID, ANISOTROPIC), refused=True)


def _judge_quality(field: CrossField, inverted: int | None, growth: float | None) -> Verdict:
    """Judge what is aligned and integrable."""
    if inverted:
        which = "1 triangle is" if inverted == 1 else f"{inverted} triangles are"
        return Verdict("suspect", f"{which} inverted in the seamless map.")
    if field.max_log_aspect > EXTREME_ASPECT:
        ratio = np.exp(field.max_log_aspect)
        return Verdict("suspect", f"The two sizes differ by a factor of {ratio:.0f}.")
    if growth is not None and growth > GROWTH:
        return Verdict(
            "suspect",
            f"The aspect does not settle: int |grad s|^2 grows by {growth - 1:.0%} when refined.",
        )
    mapped = "" if inverted is None else ", and its map has no inverted triangle"
    return Verdict("valid", f"The field is aligned and integrable{mapped}.")


def _worst(angles: FloatArray) -> float:
    """Return the largest of angles, degrees."""
    return float(np.degrees(np.abs(angles).max()))
