"""How long the edges of quads will be, told from the field before there are any."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from crossview.workflow.solution import Solution
from crossview.workflow.spots import Spot
from solvers.surface import FloatArray


@dataclass(frozen=True)
class ExpectedSizes:
    """The least and the largest edge that a field asks for, whatever the number of quads.

    Parameters
    ----------
    area : float
        Integral of e^(-H1 - H2) over the surface: divided by the number of quads, the square of the
        factor that makes edges of e^H1 and e^H2.
    least, largest : float
        Logarithm of the size, of triangles the mean.
    at_least, at_largest : Spot
        Where these are.
    """

    area: float
    least: float
    largest: float
    at_least: Spot
    at_largest: Spot

    def edges(self, quads: float) -> tuple[float, float]:
        """The least and the largest edge of so many quads, in the surface's unit."""
        half = 0.5 * np.log(self.area / quads)
        return float(np.exp(half + self.least)), float(np.exp(half + self.largest))

    @property
    def ratio(self) -> float:
        """The largest edge over the least."""
        return float(np.exp(self.largest - self.least))


def expected_sizes(solution: Solution) -> ExpectedSizes:
    """Return the sizes that the field of a solution asks for.

    Parameters
    ----------
    solution : Solution

    Examples
    --------
    >>> import crossview
    >>> from crossview.workflow.expected_sizes import expected_sizes
    >>> sizes = expected_sizes(crossview.solve(crossview.read("square")))
    >>> [round(edge, 6) for edge in sizes.edges(100)]
    [0.1, 0.1]
    """
    surface, field = solution.surface, solution.field
    H: FloatArray = field.H[surface.faces].mean(axis=1)
    H = H - H.mean()  # so that no power overflows
    half_aspect = np.abs(field.half_log_aspect).mean(axis=1)
    area = float((surface.face_areas * np.exp(-2 * H)).sum())
    small, large = H - half_aspect, H + half_aspect
    low, high = int(small.argmin()), int(large.argmax())
    ends = Spot.of_face(surface, low), Spot.of_face(surface, high)
    return ExpectedSizes(area, float(small[low]), float(large[high]), *ends)
