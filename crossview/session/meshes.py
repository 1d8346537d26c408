"""What is made of a field: separatrices, layout, quads; always of one field, never of another."""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import dataclass, field, replace

import numpy as np

from crossview.certificate import Certificate
from crossview.workflow.certification import certified
from crossview.workflow.expected_sizes import ExpectedSizes, expected_sizes
from crossview.workflow.layout import SOON, layout, misaligned_boundaries, separatrices
from crossview.workflow.pipeline import Solution
from crossview.workflow.quads import MeshOptions, fewest, quads
from crossview.workflow.spots import Spot, WorstQuad, gravest_spot, worst_quads
from solvers.fields import CrossField
from solvers.layouts import LayoutError, QuadLayout, Separatrices
from solvers.progress import Progress, between
from solvers.quads import QuadMesh
from solvers.surface import FloatArray

LAID_OUT = 0.6
"""Share of a whole computation of quads that the layout takes, for its progress."""


@dataclass(frozen=True, eq=False)
class Meshes:
    """What has been made of a field so far.

    Parameters
    ----------
    of : CrossField or None
        The field; None: there is none.
    separatrices : Separatrices or None
    settled : bool
        Whether the misaligned boundaries and what separatrices there are have been found.
    misaligned : (k, 3) float array
        A place on each boundary that the field is not aligned with.
    layout : QuadLayout or None
    trouble : LayoutError or None
        Why there can be no layout.
    quads : QuadMesh or None
    options : MeshOptions
        What the quads were made with.
    certificate : Certificate or None
        Of the quads.
    expected : ExpectedSizes or None
        How long edges will be.
    fewest : int or None
        About the least number of quads that the layout can have; None: not known.
    worst : tuple of WorstQuad
        Of the quads, to look at.
    gravest : Spot or None
        Where the gravest fault is that the certificate finds.
    """

    of: CrossField | None = None
    separatrices: Separatrices | None = None
    settled: bool = False
    misaligned: FloatArray = field(default_factory=lambda: np.empty((0, 3)))
    layout: QuadLayout | None = None
    trouble: LayoutError | None = None
    quads: QuadMesh | None = None
    options: MeshOptions = field(default_factory=MeshOptions)
    certificate: Certificate | None = None
    expected: ExpectedSizes | None = None
    fewest: int | None = None
    worst: tuple[WorstQuad, ...] = ()
    gravest: Spot | None = None


NO_MESHES = Meshes()
"""Before any layout or quads are made."""

Making = Generator[Progress, None, Meshes]


def trace(solution: Solution, made: Meshes) -> Making:
    """Trace the separatrices of a solution, and find the boundaries that it misses.

    They are exact where there is a layout, or one is soon made.
    """
    yield Progress("tracing separatrices", 0.0)
    if made.layout is None and solution.surface.n_faces <= SOON:
        return (yield from lay_out(solution, made))
    return _traced(solution, made)


def lay_out(solution: Solution, made: Meshes) -> Making:
    """Cut the surface of a solution into rectangles; what prevents it is part of the result."""
    try:
        found = yield from layout(solution)
    except LayoutError as trouble:
        return _traced(solution, replace(made, layout=None, trouble=trouble))
    yield Progress("sampling the patches", 1.0)
    _ = found.patch_mesh  # cached: drawing asks for it
    yield Progress("counting the fewest quads", 1.0)
    return _traced(solution, replace(made, layout=found, trouble=None, fewest=fewest(found)))


def make_quads(solution: Solution, made: Meshes, options: MeshOptions) -> Making:
    """Make the quad mesh of a solution, with its layout if that is not there yet."""
    laid_out = made
    share = 0.0
    if made.layout is None:
        share = LAID_OUT
        laid_out = yield from between(lay_out(solution, made), 0.0, share)
    if laid_out.layout is None:
        return laid_out
    filling = quads(laid_out.layout, options)
    filled = yield from between(filling, share, 1.0)
    _ = filled.scaled_jacobian, filled.irregular, filled.corners, filled.on_boundary
    _ = filled.edge_lengths
    certificate = certified(solution, filled)
    return replace(
        laid_out,
        quads=filled,
        options=options,
        certificate=certificate,
        worst=worst_quads(filled),
        gravest=gravest_spot(certificate, solution.surface),
    )


def _traced(solution: Solution, made: Meshes) -> Meshes:
    """Return `made` with the best separatrices there are and the boundaries that are missed."""
    _, places = misaligned_boundaries(solution)
    found = separatrices(solution, made.layout)
    return replace(
        made,
        of=solution.field,
        separatrices=found,
        settled=True,
        misaligned=places,
        expected=expected_sizes(solution),
    )
