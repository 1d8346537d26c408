"""What lies on the surface besides a field, as plain frozen values: curves, marks, quads."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.floating[Any]]
IntArray = npt.NDArray[np.integer[Any]]


@dataclass(frozen=True)
class Marker:
    """A singularity as the scene sees it: a position in space, a valence, and its state.

    Its normal is that of the surface there, of any length; zero: not known.
    """

    position: tuple[float, float, float]
    valence: int
    selected: bool = False
    locked: bool = False
    normal: tuple[float, float, float] = (0.0, 0.0, 0.0)


@dataclass(frozen=True, eq=False)
class Elements:
    """Faces (k,), vertices (k,) and edges (k, 2; vertex pairs) of the surface to point out."""

    faces: IntArray = field(default_factory=lambda: np.empty(0, int))
    vertices: IntArray = field(default_factory=lambda: np.empty(0, int))
    edges: IntArray = field(default_factory=lambda: np.empty((0, 2), int))


@dataclass(frozen=True, eq=False)
class Polylines:
    """Polylines on the surface.

    Parameters
    ----------
    points : (p, 3) float
    offsets : (n + 1,) int
        Curve i is ``points[offsets[i]:offsets[i + 1]]``.
    valences : (n,) int
        Of the singularity that each leaves: its colour; 0 or less: none.
    """

    points: FloatArray
    offsets: IntArray
    valences: IntArray

    @property
    def segments(self) -> IntArray:
        """(s, 2): pairs of points that are joined."""
        joined = np.ones(len(self.points), bool)
        joined[self.offsets[1:][np.diff(self.offsets) > 0] - 1] = False
        first = np.flatnonzero(joined)
        return np.stack([first, first + 1], axis=1)

    @property
    def segment_valences(self) -> IntArray:
        """(s,): of the curve that each segment belongs to."""
        return np.repeat(self.valences, np.maximum(np.diff(self.offsets) - 1, 0))


@dataclass(frozen=True, eq=False)
class GuideLine:
    """Where a singularity may go: straight pieces on the surface.

    Parameters
    ----------
    segments : (s, 2, 3) float
        Both ends of each piece.
    color : str
    strong : bool
        Whether it is emphasised.
    """

    segments: FloatArray
    color: str
    strong: bool


@dataclass(frozen=True)
class Plane:
    """A plane through a place; what its normal points to is cut away."""

    place: tuple[float, float, float]
    normal: tuple[float, float, float]

    def before(self, points: FloatArray) -> FloatArray:
        """Return how far points (..., 3) are before it; what is cut away is above 0."""
        return np.asarray((np.asarray(points) - self.place) @ np.asarray(self.normal))

    def moved(self, by: float) -> Plane:
        """Return it moved along its normal."""
        x, y, z = (p + by * n for p, n in zip(self.place, self.normal, strict=True))
        return Plane((x, y, z), self.normal)


@dataclass(frozen=True, eq=False)
class Measurement:
    """What is being measured.

    Parameters
    ----------
    places : (k, 3) float
        Between which.
    paths : tuple of (n, 3) float
        On the surface.
    text : str
        What has come out.
    """

    places: FloatArray
    paths: tuple[FloatArray, ...]
    text: str


@dataclass(frozen=True, eq=False)
class Quads:
    """A mesh of quadrilaterals that is drawn in place of the triangles.

    Parameters
    ----------
    points : (n, 3) float
    quads : (q, 4) int
    patch : (q,) int
        Number of the patch that each is in.
    quality : (q,) float, optional
        Scaled Jacobian.
    irregular : (k, 3) float, optional
        Positions of the irregular vertices.
    valences : (k,) int, optional
        Of the irregular vertices.
    normals : (k, 3) float, optional
        Likewise; of any length.
    apart : bool
        Whether patches share no points, so that points in one place are to be found.
    """

    points: FloatArray
    quads: IntArray
    patch: IntArray
    quality: FloatArray | None = None
    irregular: FloatArray = field(default_factory=lambda: np.empty((0, 3)))
    valences: IntArray = field(default_factory=lambda: np.empty(0, int))
    normals: FloatArray = field(default_factory=lambda: np.empty((0, 3)))
    apart: bool = False
