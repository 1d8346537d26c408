"""Whether a field is what it seems: E near zero is not enough."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from solvers.algebra.factorization import RESIDUAL_BOUND
from solvers.fields.crossfield import CrossField
from solvers.remedies import ANISOTROPIC, MAKE_VALID, Remedy, in_words

INTEGRABLE = 1e-8
"""E below which a field counts as integrable. Chosen, far above what solves leave, some 1e-14."""

EXTREME_ASPECT = 3.0
"""|H2 - H1| beyond which quads are too stretched to trust: twenty to one. Chosen."""

GROWTH = 1.2
"""Growth of int |grad s|^2 on a once refined mesh that tells a forced field, a factor.

Chosen between what was measured: 1.05 to 1.11 where a field is possible, 1.35 to 1.42 where not.
"""


@dataclass(frozen=True)
class Verdict:
    """A judgement on a field.

    Parameters
    ----------
    status : {"valid", "suspect", "impossible", "unknown"}
        The judgement; "unknown" where the field is not solved well enough to be judged.
    reason : str
        Why, in a sentence.
    remedies : tuple of Remedy
        What may be done about it.

    Examples
    --------
    >>> from solvers.fields import Verdict
    >>> verdict = Verdict("suspect", "1 triangle is turned over in the integrated map.")
    >>> print(verdict)
    1 triangle is turned over in the integrated map.
    """

    status: Literal["valid", "suspect", "impossible", "unknown"]
    reason: str
    remedies: tuple[Remedy, ...] = ()

    def __str__(self) -> str:
        """Return the reason and what may be done, in a sentence."""
        if not self.remedies:
            return self.reason
        return f"{self.reason.rstrip('.')}; {in_words(self.remedies)}."


def judge(
    field: CrossField, flips: int | None, growth: float | None = None, tolerance: float = 1.75e-4
) -> Verdict:
    """Judge a field by topology, alignment, integrability, flips, aspect and growth.

    Parameters
    ----------
    field : CrossField
        What to judge.
    flips : int or None
        Triangles turned over in its seamless map; None where there is no such map.
    growth : float, optional
        int |grad s|^2 on a once refined mesh over that of the field.
    tolerance : float, optional
        Largest holonomy defect of a valid field, radians.

    Returns
    -------
    Verdict
        With the first reason found not to trust the field.

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
    >>> judge(solver.solve([]), flips=None).status  # aligned with itself all around
    'valid'
    >>> places = [surface.closest_point([x, 0.0, 0.0]) for x in (1.4, -0.6)]
    >>> pair = [Singularity(place, valence) for place, valence in zip(places, (3, 5))]
    >>> judge(solver.solve(pair), flips=None).status
    'impossible'
    """
    indices = sorted(s.index for s in field.singularities)
    surface = field.surface
    if surface.genus == 1 and not surface.boundary_loops and indices == [-1, 1]:
        return Verdict(
            "impossible",
            "No quadrangulation of a torus has one valence 3, one valence 5 and nothing else "
            "(Izmestiev et al. 2013).",
        )
    if not field.residual <= RESIDUAL_BOUND:
        return Verdict(
            "unknown",
            f"Not known: the linear system is solved to a residual of {field.residual:.1g} only; "
            "look for triangles without area.",
        )
    worst = float(np.degrees(np.abs(field.defects).max(initial=0.0)))
    if worst > np.degrees(tolerance):
        return Verdict(
            "impossible",
            f"No isotropic field is aligned: a holonomy defect is {worst:.3g} degrees.",
            (MAKE_VALID, ANISOTROPIC),
        )
    off = float(np.degrees(np.abs(field.feature_misalignment).max(initial=0.0)))
    if off > np.degrees(tolerance):
        return Verdict(
            "suspect",
            f"The field is {off:.3g} degrees off a feature curve.",
            (ANISOTROPIC,),
        )
    return _judge_aligned(field, flips, growth)


def _judge_aligned(field: CrossField, flips: int | None, growth: float | None) -> Verdict:
    if field.energy > INTEGRABLE:
        return Verdict(
            "suspect", f"The field is aligned but not integrable: E = {field.energy:.2g}."
        )
    if flips:
        which = "1 triangle is" if flips == 1 else f"{flips} triangles are"
        return Verdict("suspect", f"{which} turned over in the integrated map.")
    if field.max_log_aspect > EXTREME_ASPECT:
        ratio = np.exp(field.max_log_aspect)
        return Verdict("suspect", f"The two sizes differ by a factor of {ratio:.0f}.")
    if growth is not None and growth > GROWTH:
        return Verdict(
            "suspect",
            f"The aspect does not settle: int |grad s|^2 grows by {growth - 1:.0%} when refined.",
        )
    mapped = "" if flips is None else ", and its map has no flip"
    return Verdict("valid", f"The field is aligned and integrable{mapped}.")
