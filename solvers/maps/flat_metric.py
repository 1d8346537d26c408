"""Flat metrics with prescribed cones: maps that cannot have an inverted triangle.

Lengths of edges make a metric, and where each sector's angles add up to the quarter turns of its
quads and nothing turns around handles and between aligned edges, the triangles laid out side by
side are a seamless map: upright, whatever the lengths, for a triangle has no other orientation.
Lengths near those that a field asks for are changed by least-norm Newton steps until they do.
Where a triangle becomes too flat an edge is flipped, which gives vertices of large valence the
triangles that they need; where none can be, the one opposite the flat angle is split.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from solvers.errors import SolveError
from solvers.maps.flatness import Flatness
from solvers.maps.image_lengths import ImageLengths
from solvers.maps.matching import Matching
from solvers.surface.triangulation import FloatArray

STEPS = 15
"""Newton steps at most, from all starts together: one factorisation each.

Chosen: of the fields that get a metric within twice as many, hardly any needs more than ten.
"""

FLAT = 1e-9
"""Largest angle by which a sector or a loop may be off for the metric to be flat, radians.

Chosen, above rounding; what is left is taken away by the least change of the images.
"""

FARTHEST = 1.0
"""Largest change of the logarithm of a length in a step. Chosen."""

OWN = (0.0, 0.25, 0.5, 1.0)
"""Shares of the surface's own lengths in those that are started from. Chosen."""

TRIALS = 3
"""How often a step is tried, half as long each time, before triangles are flipped and split.

Chosen: smaller steps lead nowhere.
"""


@dataclass(frozen=True, eq=False)
class FlatMetric:
    """A seamless map as a metric.

    Parameters
    ----------
    matching : Matching
        The triangles after flips and splits, and the topology of the field, which is the same.
    images : (m, 3, 2) float array
        Image of each halfedge in the frame of its triangle's cross, upright.
    distance : float
        Root mean square of how far the logarithms of lengths are from those asked for.
    """

    matching: Matching
    images: FloatArray
    distance: float


def flat_metric(
    matching: Matching, log_lengths: FloatArray, theta: FloatArray
) -> FlatMetric | None:
    """Return the flat metric found from lengths that a field asks for.

    Parameters
    ----------
    matching : Matching
        Of the field.
    log_lengths : (3 m,) float array
        Logarithm of the length that each halfedge's image should have; the same for twins.
    theta : (m,) float array
        Angles of the field's crosses in the frames of the triangles, radians: where nothing
        fixes the direction of the images, they are turned to be nearest to it.

    Returns
    -------
    FlatMetric or None
        None if none is found.

    Notes
    -----
    Cone metrics by Newton's method in logarithms of lengths: Capouellez and Zorin 2023 ("Metric
    optimization in Penner coordinates"); flips of triangles that do not close by Ptolemy's theorem,
    as Springborn 2020. Here others are flipped without a change of the metric, and only where they
    are too flat, so that images stay near to what the field asks for.
    """
    if (matching.quads < 1).any():
        return None  # no map has room for a sector without quads
    left = STEPS
    for start in _starts(matching, log_lengths, theta):
        state: _State | None = start
        while state is not None:
            if state.flat:
                return state.found()
            if left == 0:
                return None
            left -= 1
            state = state.stepped()
    return None


class _State:
    """Lengths of triangles that close, not too flat, and by how much they are off a flat metric."""

    def __init__(self, lengths: ImageLengths) -> None:
        while lengths.split_flat():
            pass
        self._lengths, self._target = lengths, lengths.target()
        self._flatness = Flatness(lengths, self._target)
        self.off = self._flatness.off(self._target)

    @property
    def error(self) -> float:
        """Sum of the squares of what is off."""
        return float(self.off @ self.off)

    @property
    def flat(self) -> bool:
        """Whether nothing is off but rounding."""
        return bool(np.abs(self.off).max(initial=0.0) <= FLAT)

    def found(self) -> FlatMetric:
        """Return the metric, which is flat."""
        lengths = self._lengths
        images = self._flatness.images(self._target)
        return FlatMetric(lengths.matching(), images, lengths.distance)

    def stepped(self) -> _State | None:
        """Return where a Newton step leads, halved until it helps; None if it does not."""
        try:
            change = self._flatness.change(self._target, self.off)
        except SolveError:
            return None
        share = min(1.0, FARTHEST / max(float(np.abs(change).max()), 1e-300))
        for _ in range(TRIALS):
            trial = self._lengths.copied()
            trial.log_lengths += share * change
            if trial.close():
                state = _State(trial)
                if state.error < (1 - 0.2 * share) * self.error:
                    return state
            share /= 2
        relieved = self._lengths.relieved()
        return None if relieved is None else _State(relieved)


def _starts(matching: Matching, log_lengths: FloatArray, theta: FloatArray) -> list[_State]:
    """Return metrics of triangles that close to start from, that nearest to a flat one first."""
    own = np.log(matching.triangulation.lengths.reshape(-1))
    own += (log_lengths - own).mean()
    found = []
    for share in OWN:
        lengths = ImageLengths(matching, log_lengths, theta)
        lengths.log_lengths += share * (own - log_lengths)
        if lengths.close():
            found.append(_State(lengths))
    return sorted(found, key=lambda state: state.error)
