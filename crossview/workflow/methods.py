"""How each method that is not isotropic finds its field, and how its field is judged."""

from __future__ import annotations

from collections.abc import Generator

import numpy as np

from crossview.cases.model import CaseError, Options
from crossview.workflow.sizes import refined_sizes
from solvers.fields import (
    AlignedField,
    IntegratedField,
    Limits,
    PreparedSurface,
    aligned_field,
    alternating_field,
    anisotropic_field,
)
from solvers.maps import seamless_map
from solvers.progress import Progress, relayed
from solvers.surface import QUARTER, FloatArray

Integration = Generator[Progress, None, IntegratedField]

LEAST_ROUGHNESS = 1e-12
"""int |grad s|^2 below which the aspect is even, and its growth only rounding."""


def integrate(
    method: str, aligned: AlignedField, options: Options, sizes: FloatArray | None
) -> Integration:
    """Find the field of a method, from the aligned field.

    Parameters
    ----------
    method : {"aligned", "anisotropic", "alternating"}
    aligned : AlignedField
    options : Options
    sizes : (n,) or (n, 2) float array, optional
        At the vertices of the surface solved on.
    """
    if method == "anisotropic":
        return (yield from anisotropic_field(aligned, sizes))
    if method == "alternating":
        return (yield from alternating_field(aligned, options.proximal_weight))
    return IntegratedField(aligned, aligned.start)


def growth_when_refined(
    coarse: IntegratedField, options: Options, sizes: FloatArray | None
) -> Generator[Progress, None, float]:
    """Solve again on a once refined mesh; return how much int |grad s|^2 grows.

    Raises
    ------
    CaseError
        Turns are asked for around handles: the refined mesh may have other handle loops.
    """
    field, prepared = coarse.field, coarse.aligned.prepared.refined()
    if field.surface.genus and any(options.turns or ()):
        raise CaseError(
            "verify cannot follow turns on a surface with handles", "options", "leave one out"
        )
    again = aligned_field(prepared, _same_turns(coarse.aligned, prepared))
    finer = None if sizes is None else refined_sizes(sizes, prepared.refinement)
    solved = yield from _unseen(integrate(coarse.method, again, options, finer))
    before, after = field.aspect_roughness, solved.field.aspect_roughness
    return after / before if before > LEAST_ROUGHNESS else 1.0


def inverted_triangles(integrated: IntegratedField | None, limits: Limits) -> int | None:
    """How many triangles are inverted in the map of a field; None if it has none."""
    if integrated is None or integrated.field.energy > limits.energy:
        return None
    return len(seamless_map(integrated).inverted)


def _same_turns(aligned: AlignedField, finer: PreparedSurface) -> list[int] | None:
    """The turns that give the same layout where a defect is next to 45 degrees.

    A defect just below 45 degrees may come out just above -45 on the refined mesh. Around handles
    the two meshes may have different loops, and the nearest turns are taken on each.
    """
    before = aligned.isotropic.defects
    if finer.surface.genus or not len(before):
        return None
    after = finer.operators.own.holonomy.defects(finer.singularities)
    shift = np.rint((after - before) / QUARTER).astype(int)
    return [int(turn) for turn in shift + np.asarray(aligned.turns)]


def _unseen(computation: Integration) -> Integration:
    """The same computation, its fields not those that are being solved for."""
    stage = "verifying on a refined mesh"
    return relayed(computation, lambda step: Progress(stage, step.fraction))
