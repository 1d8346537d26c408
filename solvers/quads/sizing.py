"""How many edges arcs need for none to be much longer than the others."""

from __future__ import annotations

import numpy as np

from solvers.layouts.layout import QuadLayout
from solvers.number_checks import real_number
from solvers.quads.collapse import Condition
from solvers.quads.integer_program import WHOLE
from solvers.quads.stretches import polylines, stretches

MAX_SIZE_RATIO = 4.0
"""Mean length of the edges along an arc, at most, in the mean edge of all.

Measured on annuli where sizes span 30 to 55: with 4.5 more than 0.5 % of the area is lost and
edges are off by 1.3 % of the radius, with 3.5 quads become poorer and single edges longer.
"""


def size_conditions(
    layout: QuadLayout, longest: float, turn: float | None = None
) -> list[Condition]:
    """Return how many edges arcs need so that these are neither too long nor too bent, on average.

    Parameters
    ----------
    layout : QuadLayout
        The rectangles on the surface.
    longest : float
        How long they may be, on the surface.
    turn : float, optional
        By how much, radians, the surface may turn along one; by any if not given.

    Returns
    -------
    list of Condition
        For single arcs that are longer, or bend by more, and for consecutive ones that are, or do,
        together: an edge for all.

    Raises
    ------
    CrossviewError
        If the length or the turn is not positive.

    Notes
    -----
    Numbers are rounded for single arcs: so many that none is longer take quads from where they are
    needed, and as few as fit leave edges of twice the length.

    Where the surface bends by more at once, as over a crease, one edge's turn is counted: no number
    of edges follows it.

    Examples
    --------
    The four sides of a square:

    >>> from solvers import run
    >>> from solvers.fields import IntegratedField, aligned_field, prepare
    >>> from solvers.layouts import quad_layout
    >>> from solvers.primitives import square
    >>> from solvers.quads import size_conditions
    >>> aligned = aligned_field(prepare(square(n=4)))
    >>> layout = run(quad_layout(IntegratedField(aligned, aligned.start)))
    >>> [condition.least for condition in size_conditions(layout, 0.3)]
    [3, 3, 3, 3]
    """
    longest = real_number("the longest edge", longest, above=0)
    every = np.arange(layout.tmesh.n_arcs)
    turn = np.inf if turn is None else real_number("the largest turn", turn, above=0)
    wanted = []
    for line in polylines(layout, every):
        wanted.append(np.maximum(line.lengths / longest, np.minimum(line.turns / turn, 1)).sum())
    found = []
    for stretch in stretches(layout.arrangement, np.ones(len(every), dtype=bool)):
        short: list[int] = []
        total = 0.0
        for arc in stretch.arcs.tolist():
            if wanted[arc] > 1 - WHOLE:
                found.append(Condition(np.array([arc]), int(np.rint(wanted[arc]))))
                short, total = [], 0.0
                continue
            short.append(arc)
            total += wanted[arc]
            if total > 1 - WHOLE:
                found.append(Condition(np.unique(short), 1))
                short, total = [], 0.0
    return found
