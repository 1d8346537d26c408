"""What a reader returns: points and polygons, to be triangulated."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from solvers.errors import SurfaceError, counted, listed
from solvers.surface import FloatArray, IntArray


@dataclass(frozen=True)
class Polygons:
    """The surface elements of a file, as they stand there.

    Attributes
    ----------
    points : (n, 3) float array
    sizes : (m,) int array
        Number of corners of each polygon.
    corners : (sum of sizes,) int array
        The polygons' corners one after another.
    notes : tuple of str
        What was left out, in plain words.
    """

    points: FloatArray
    sizes: IntArray
    corners: IntArray
    notes: tuple[str, ...] = ()

    @classmethod
    def of_blocks(
        cls, points: FloatArray, blocks: Sequence[IntArray], notes: Sequence[str] = ()
    ) -> Polygons:
        """Join arrays (m_i, s_i) of polygons with s_i corners each."""
        sizes = [np.full(len(block), block.shape[1]) for block in blocks]
        corners = [block.reshape(-1) for block in blocks]
        none = [np.empty(0, dtype=np.int64)]
        return cls(
            points, np.concatenate(sizes + none), np.concatenate(corners + none), tuple(notes)
        )

    def triangles(self) -> tuple[IntArray, tuple[str, ...]]:
        """Return the (k, 3) triangles, larger polygons split by ear cutting, and the notes.

        Raises
        ------
        SurfaceError
            When a larger polygon has corners that do not exist.
        """
        larger = int((self.sizes != 3).sum())
        if not larger:
            return self.corners.reshape(-1, 3), self.notes
        owner = np.repeat(np.arange(len(self.sizes)), self.sizes)
        bad = np.unique(owner[(self.corners < 0) | (self.corners >= len(self.points))])
        if len(bad):
            raise SurfaceError(
                f"polygons name vertices outside 0..{len(self.points) - 1}",
                f"polygons {listed(bad)}",
                "mend the file they come from",
                bad,
                "faces",
            )
        import pyvista as pv  # takes a while, and most files hold triangles only

        starts = np.cumsum(self.sizes) - self.sizes
        mesh = pv.PolyData(self.points, np.insert(self.corners, starts, self.sizes))
        note = f"split {counted(larger, 'polygon')} of more than three corners into triangles"
        return mesh.triangulate().regular_faces.astype(np.int64), (*self.notes, note)
