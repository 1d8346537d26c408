"""The direction of crosses that nothing fixes: that in which separatrices join singularities."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from solvers.algebra.operators import midpoint_offsets
from solvers.fields.aligned import AlignedField, aligned_field
from solvers.fields.crossfield import CrossField
from solvers.fields.isotropic import IsotropicSolver
from solvers.fields.prepared import PreparedSurface
from solvers.layouts.charts import Chart
from solvers.layouts.crossings import Crossings, crossings
from solvers.layouts.nodes import singular_nodes, starts_at
from solvers.layouts.tracing import Chords, Traces, trace
from solvers.singularities.budget import Singularity
from solvers.surface.triangulation import QUARTER, BoolArray, FloatArray, wrap

FAR = 1.5
"""Length of the curves that are looked at, in square roots of the area in the map. Chosen."""

ALIKE = np.radians(1.0)
"""Spread of directions between nodes that count as one when a turn is chosen, radians. Chosen."""

WILD = 0.25
"""Relative difference of a side's two images in triangles too flat to tell crosses at. Chosen."""

SETTLED, ROUNDS = 1e-4, 5
"""Turn, radians, after which none more is sought, and how many are at most. Chosen."""


def in_joining_gauge(
    solver: IsotropicSolver, singularities: Sequence[Singularity]
) -> IsotropicSolver:
    """Return a solver whose crosses are turned so that separatrices of a configuration join.

    Parameters
    ----------
    solver : IsotropicSolver
        Returned as it is where something fixes the direction of its crosses.
    singularities : sequence of Singularity
        On its surface.

    Returns
    -------
    IsotropicSolver
        With the same factors.

    Examples
    --------
    >>> from itertools import product
    >>> from solvers import IsotropicSolver, Singularity
    >>> from solvers.layouts import field_separatrices, in_joining_gauge
    >>> from solvers.primitives import sphere
    >>> surface = sphere(subdivisions=3)
    >>> corners = product((-0.6, 0.6), repeat=3)
    >>> cube = [Singularity(surface.closest_point(corner), 3) for corner in corners]
    >>> solver = in_joining_gauge(IsotropicSolver(surface), cube)
    >>> len(field_separatrices(solver.solve(cube)).ends)  # the edges of the cube
    12
    """
    if not solver.gauge_free or not singularities:
        return solver
    return solver.in_gauge(joining_gauge(solver.solve(singularities)))


def joined_field(prepared: PreparedSurface, turns: Sequence[int] | None = None) -> AlignedField:
    """Return the aligned field, turned so that separatrices join where nothing else fixes it.

    Parameters
    ----------
    prepared : PreparedSurface
        The surface and the configuration.
    turns : sequence of int, optional
        As of `aligned_field`.

    Returns
    -------
    AlignedField
        As of `aligned_field`.

    Raises
    ------
    CrossviewError
        As `aligned_field`.

    Examples
    --------
    On a sphere nothing fixes the direction of the crosses. Turned so, the eight corners of a cube
    have the twelve edges between them for separatrices:

    >>> from itertools import product
    >>> from solvers import run
    >>> from solvers.fields import IntegratedField, prepare
    >>> from solvers.layouts import joined_field, quad_layout
    >>> from solvers.primitives import sphere
    >>> from solvers.singularities import Singularity
    >>> surface = sphere(subdivisions=3)
    >>> corners = product((-0.6, 0.6), repeat=3)
    >>> cube = [Singularity(surface.closest_point(corner), 3) for corner in corners]
    >>> aligned = joined_field(prepare(surface, cube))
    >>> layout = run(quad_layout(IntegratedField(aligned, aligned.start)))
    >>> layout.patches, layout.tmesh.n_arcs
    (6, 12)
    """
    solver = prepared.operators.solver
    turned = in_joining_gauge(solver, prepared.singularities)
    like = None if turned is solver else turned.solve(prepared.singularities)
    return aligned_field(prepared, turns, like=like)


def joining_gauge(field: CrossField) -> float:
    """Return the angle to turn all crosses by so that most neighbours lie on common lines.

    Curves that run along the line between two singularities tell its direction best, so the turn
    is found again in the field once turned.

    Parameters
    ----------
    field : CrossField
        Isotropic, with nothing that fixes its direction.

    Returns
    -------
    float
        Radians.
    """
    turn = 0.0
    for _ in range(ROUNDS):
        found = _turn(field.turned(turn))
        turn += found
        if abs(found) < SETTLED:
            break
    return turn


def _turn(field: CrossField) -> float:
    chart = chart_by_sides(field)
    nodes = singular_nodes(chart, field)
    far = FAR * float(chart.area) ** 0.5
    traces = trace(chart, nodes, starts_at(chart, nodes), 0.0, far)
    traces = replace(traces, chords=traces.chords[before_winding(traces.chords)])
    return _best_gauge(traces, crossings(chart, traces.chords))


def before_winding(chords: Chords) -> BoolArray:
    """Return which chords (c,) are before their trace comes to a triangle for the third time.

    Where H is large a curve may go round and round a few triangles, and cross others, and itself,
    millions of times.
    """
    order = np.lexsort((chords.start, chords.face, chords.trace))
    trace, face = chords.trace[order], chords.face[order]
    third = order[2:][(trace[2:] == trace[:-2]) & (face[2:] == face[:-2])]
    until = np.full(chords.trace.max(initial=-1) + 1, np.inf)
    np.minimum.at(until, chords.trace[third], chords.start[third])
    return np.asarray(chords.start < until[chords.trace])


def chart_by_sides(field: CrossField) -> Chart:
    """Return the triangles by the size and the cross at the middle of each side.

    As theta is conjugate to H, two triangles have nearly the same image of the side they share.
    With that of their barycentres alone, errors along a curve add up to half a degree.
    """
    solved = field.solved
    t = solved.triangulation
    size = (solved.H[t.faces] + solved.H[t.faces[:, [1, 2, 0]]]) / 2
    angle = t.directions.reshape(-1, 3) - solved.theta[:, None] - midpoint_offsets(t, solved.H)
    sides = t.lengths * np.exp(-size + 1j * angle)
    sides -= sides.mean(axis=1)[:, None]
    rough = Chart.of_field(field)
    off = np.abs(sides - rough.images) / np.abs(rough.images)
    over = (sides[:, 0].conj() * -sides[:, 2]).imag <= 0
    wild = over | (off.max(axis=1) > WILD)
    return replace(rough, images=np.where(wild[:, None], rough.images, sides))


def _best_gauge(traces: Traces, crossings: Crossings) -> float:
    """Return the angle to turn all crosses by so that most neighbouring nodes lie on lines.

    Every crossing of traces from two nodes tells the direction from one to the other in the map;
    directions that agree vote together, near nodes more.
    """
    chords = traces.chords
    a, b = crossings.chord.T
    to_right = (chords.axis[b] - chords.axis[a]) % 4 == 3
    way = crossings.at[:, 0] + 1j * np.where(to_right, 1, -1) * crossings.at[:, 1]
    angle = wrap(np.angle(way), QUARTER)
    # Nearer than some triangles it is the mesh that speaks.
    counts = np.abs(way) > 4 * traces.chart.edge_length
    weight = counts / np.maximum(np.abs(way), 1e-300) ** 2
    if not counts.any():
        return 0.0
    heaviest = np.argsort(-weight, kind="stable")[:2000]
    angle, weight = angle[heaviest], weight[heaviest]

    def apart(one: FloatArray) -> FloatArray:
        return wrap(angle - one, QUARTER)

    votes = [weight @ np.exp(-0.5 * (apart(one) / ALIKE) ** 2) for one in angle]
    best = angle[int(np.argmax(votes))]
    kernel = weight * np.exp(-0.5 * (apart(best) / ALIKE) ** 2)
    return float(wrap(best + kernel @ apart(best) / kernel.sum(), QUARTER))
