"""A T-mesh: rectangles glued along arcs, some of which end in the middle of another's side."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from solvers.frozen import freeze_arrays
from solvers.surface.triangulation import BoolArray, FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class TMesh:
    """Rectangles, the arcs between them, and the nodes where arcs meet.

    A half-arc is ``2 * arc``, or ``2 * arc + 1`` for the arc run backwards. A rectangle may be
    glued to itself: one makes a torus or an annulus.

    Parameters
    ----------
    arcs : (A, 2) int array
        The nodes each arc runs from and to.
    lengths : (A,) float array
        Length of each arc in the seamless map.
    arc_on_boundary : (A,) bool array
        Whether an arc lies on the boundary of the surface.
    node_valence : (N,) int array
        Arcs that leave each node; an inner node with three is a T-junction or a valence 3.
    critical : (N,) bool array
        Singularities and corners: the nodes that quantisation has to keep apart.
    node_on_boundary : (N,) bool array
        Whether a node lies on the boundary of the surface.
    side_offsets : (4 R + 1,) int array
        Side j of rectangle r is ``side_halfarcs[side_offsets[4 r + j]:side_offsets[4 r + j + 1]]``.
    side_halfarcs : (K,) int array
        Counter-clockwise, the rectangle on their left.

    Examples
    --------
    One rectangle of 2 by 1; its corners are the nodes, its sides the arcs:

    >>> import numpy as np
    >>> from solvers.layouts import TMesh
    >>> tmesh = TMesh(
    ...     arcs=np.array([[0, 1], [1, 2], [2, 3], [3, 0]]),
    ...     lengths=np.array([2.0, 1.0, 2.0, 1.0]),
    ...     arc_on_boundary=np.ones(4, dtype=bool),
    ...     node_valence=np.full(4, 2),
    ...     critical=np.ones(4, dtype=bool),
    ...     node_on_boundary=np.ones(4, dtype=bool),
    ...     side_offsets=np.arange(5),
    ...     side_halfarcs=np.array([0, 2, 4, 6]),
    ... )
    >>> tmesh.n_rectangles, tmesh.area, tmesh.side_totals(tmesh.lengths).tolist()
    (1, 2.0, [[2.0, 1.0, 2.0, 1.0]])
    """

    arcs: IntArray
    lengths: FloatArray
    arc_on_boundary: BoolArray
    node_valence: IntArray
    critical: BoolArray
    node_on_boundary: BoolArray
    side_offsets: IntArray
    side_halfarcs: IntArray

    def __post_init__(self) -> None:
        freeze_arrays(self)

    @property
    def n_arcs(self) -> int:
        """Number of arcs."""
        return len(self.arcs)

    @property
    def n_nodes(self) -> int:
        """Number of nodes."""
        return len(self.node_valence)

    @property
    def n_rectangles(self) -> int:
        """Number of rectangles."""
        return len(self.side_offsets) // 4

    def side(self, rectangle: int, number: int) -> IntArray:
        """Return the half-arcs of one side of a rectangle.

        Parameters
        ----------
        rectangle : int
            Which.
        number : {0, 1, 2, 3}
            Of the side.
        """
        at = 4 * rectangle + number
        return self.side_halfarcs[self.side_offsets[at] : self.side_offsets[at + 1]]

    def side_totals(self, values: FloatArray) -> FloatArray:
        """Return the sums over the sides of rectangles of values of arcs.

        Parameters
        ----------
        values : (A,) float array
            One for each arc.

        Returns
        -------
        (R, 4) float array
            One for each side.
        """
        running = np.concatenate([[0.0], np.cumsum(values[self.side_halfarcs // 2])])
        return np.asarray(np.diff(running[self.side_offsets])).reshape(-1, 4)

    @cached_property
    def area(self) -> float:
        """Area of all rectangles in the map."""
        sides = self.side_totals(self.lengths)
        return float((sides[:, 0] * sides[:, 1]).sum())
