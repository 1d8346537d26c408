"""Whether a field is what it seems: E near zero is not enough."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from solvers.algebra.factorization import RESIDUAL_BOUND
from solvers.errors import counted
from solvers.fields.crossfield import CrossField
from solvers.fields.holonomy import Holonomy
from solvers.number_checks import real_number, whole_number
from solvers.remedies import ANISOTROPIC, MAKE_VALID, Remedy, in_words
from solvers.singularities.decision import Existence, existence
from solvers.singularities.theorems import Theorem
from solvers.surface.triangulation import BoolArray, FloatArray

TOLERANCE_DEGREES = 0.01
"""Holonomy defects and misalignments below are none, unless a case says otherwise. Chosen."""

INTEGRABLE = 1e-8
"""E below which nothing but rounding is left. Chosen, far above what solves leave, some 1e-14."""

NEARLY_INTEGRABLE = 0.01
"""E up to which an aligned field is the isotropic one as far as the mesh can tell.

Chosen: a fifth of a degree of defect on an annulus. A configuration made valid on one refinement of
a surface has defects of some hundredths of a degree on another.
"""

CLOSED = 1e-6
"""Largest angle, radians, by which neighbouring crosses fail to match for rounding alone.

Chosen: real surfaces reach 1e-9.
"""

EXTREME_ASPECT = 3.0
"""|H2 - H1| beyond which quads are stretched: twenty to one. Chosen."""


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
    status : {"valid", "stretched", "not found", "impossible"}
        "stretched" of an injective map with extreme aspect, "not found" where there is none or
        the field is not what it should be, "impossible" where a theorem forbids it.
    reason : str
        Why, in a sentence.
    remedies : tuple of Remedy, optional
        What may be done about it.
    refused : bool, optional
        Whether no layout is made of such a field; never of a valid one.
    theorem : Theorem, optional
        What forbids any quad mesh; of what is impossible, and of nothing else.

    Examples
    --------
    >>> from solvers.fields import Verdict
    >>> verdict = Verdict("not found", "1 triangle is inverted in the seamless map.")
    >>> print(verdict)
    1 triangle is inverted in the seamless map.
    """

    status: Literal["valid", "stretched", "not found", "impossible"]
    reason: str
    remedies: tuple[Remedy, ...] = ()
    refused: bool = False
    theorem: Theorem | None = None

    def __str__(self) -> str:
        """Return the reason and what may be done, in a sentence."""
        if not self.remedies:
            return self.reason
        return f"{self.reason.rstrip('.')}; {in_words(self.remedies)}."


def judge(
    field: CrossField,
    inverted: int | None = None,
    limits: Limits = STRICT,
    *,
    wrong_windings: int = 0,
    known: Existence | None = None,
) -> Verdict:
    """Judge a field by topology, closing, alignment, integrability, its map and its aspect.

    Parameters
    ----------
    field : CrossField
        What to judge.
    inverted : int, optional
        Inverted triangles in its seamless map; None where none was made: then it is not valid.
    limits : Limits, optional
        What is valid.
    wrong_windings : int, optional
        Vertices of the map around which the angles of the images do not add up to their quads.
    known : Existence, optional
        What topology says, as of `field_existence`; by default of valences and corners alone.

    Returns
    -------
    Verdict
        With the first reason found not to trust the field.

    Raises
    ------
    CrossviewError
        Unless the numbers are whole numbers from 0.

    Notes
    -----
    `solvers.singularities.decide` tells what is impossible.

    Examples
    --------
    >>> from solvers.fields import IsotropicSolver, judge
    >>> from solvers.primitives import torus
    >>> from solvers.singularities import Singularity
    >>> surface = torus(n=24)
    >>> solver = IsotropicSolver(surface)
    >>> judge(solver.solve([]), inverted=0).status  # aligned with itself all around
    'valid'
    >>> places = [surface.closest_point([x, 0.0, 0.0]) for x in (1.4, -0.6)]
    >>> pair = [Singularity(places[0], valence=3), Singularity(places[1], valence=5)]
    >>> judge(solver.solve(pair)).status
    'impossible'
    """
    if inverted is not None:
        inverted = whole_number("the number of inverted triangles", inverted, 0)
    wrong_windings = whole_number("the number of wrong windings", wrong_windings, 0)
    if known is None:
        known = existence(field.surface, field.singularities, field.corners)
    if known.theorem is not None:
        reason, theorem = str(known.theorem), known.theorem
        return Verdict("impossible", reason, known.remedies, refused=True, theorem=theorem)
    return (
        _judge_solve(field)
        or _judge_alignment(field, limits)
        or _judge_integrability(field, limits)
        or _judge_map(field, inverted, wrong_windings)
    )


def _judge_solve(field: CrossField) -> Verdict | None:
    if not field.residual <= RESIDUAL_BOUND:
        return Verdict(
            "not found",
            f"The linear system is solved to a residual of {field.residual:.1g} only; "
            "look for triangles without area.",
            refused=True,
        )
    if not field.max_closing_error <= CLOSED:
        apart = np.degrees(field.max_closing_error)
        return Verdict(
            "not found",
            f"The crosses of two neighbouring triangles differ by {apart:.2g} degrees more "
            "than quarter turns.",
            refused=True,
        )
    return None


def _judge_alignment(field: CrossField, limits: Limits) -> Verdict | None:
    both = (MAKE_VALID, ANISOTROPIC)
    if limits.missed(field.defects).any():
        worst = _worst(field.defects)
        reason = f"No isotropic field is aligned: a holonomy defect is {worst:.3g} degrees."
        return Verdict("not found", reason, both, refused=True)
    if limits.missed(field.boundary_misalignment).any():
        off = _worst(field.boundary_misalignment)
        reason = f"The field is {off:.3g} degrees off a boundary."
        return Verdict("not found", reason, both, refused=True)
    if limits.missed(field.feature_misalignment).any():
        off = _worst(field.feature_misalignment)
        reason = f"The field is {off:.3g} degrees off a feature curve."
        return Verdict("not found", reason, (ANISOTROPIC,), refused=True)
    return None


def _judge_integrability(field: CrossField, limits: Limits) -> Verdict | None:
    if field.energy <= limits.energy:
        if field.convergence.converged:
            return None
        return Verdict("not found", f"The iteration has not converged: E = {field.energy:.2g}.")
    reason = f"The field is aligned but not integrable: E = {field.energy:.2g}."
    if field.energy <= NEARLY_INTEGRABLE:
        return Verdict("not found", reason)
    return Verdict("not found", reason, (MAKE_VALID, ANISOTROPIC), refused=True)


def _judge_map(field: CrossField, inverted: int | None, wrong_windings: int) -> Verdict:
    """Judge what is aligned and integrable."""
    if inverted is None:
        return Verdict("not found", "The field is aligned and integrable; no map was made of it.")
    if inverted:
        which = "1 triangle is" if inverted == 1 else f"{inverted} triangles are"
        return Verdict("not found", f"{which} inverted in the seamless map.")
    if wrong_windings:
        which = counted(wrong_windings, "vertex")
        return Verdict(
            "not found",
            f"Around {which} the angles of the seamless map do not add up to the quads there.",
        )
    if field.max_log_aspect > EXTREME_ASPECT:
        ratio = np.exp(field.max_log_aspect)
        return Verdict("stretched", f"The two sizes differ by a factor of {ratio:.0f}.")
    return Verdict("valid", "The field is aligned and integrable, and its map is injective.")


def _worst(angles: FloatArray) -> float:
    """Return the largest of angles, degrees."""
    return float(np.degrees(np.abs(angles).max()))
