"""Sparse matrices summed from element matrices, on a pattern that is found once.

Arrays over elements are (m, ...) to the reader; those made here and in
`solvers.fields.integrability` lie in memory with the elements along the fast axis, so that each
component is one run of numbers.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np
from scipy.sparse import csc_array

from solvers.surface.triangulation import FloatArray, IntArray


class ElementAssembly:
    """Sums of symmetric element matrices over shared unknowns.

    Parameters
    ----------
    unknowns : (m, k) int array
        The unknown behind each row of each element matrix; -1 for none. No element has one twice.
    n : int
        Number of unknowns.
    """

    def __init__(self, unknowns: IntArray, n: int) -> None:
        self.n = n
        self._unknowns = np.ascontiguousarray(unknowns.T)
        self._pairs = np.tril_indices(unknowns.shape[1])

    @cached_property
    def _pattern(self) -> tuple[IntArray, IntArray, IntArray]:
        """Rows and starts of the columns of the lower triangle; the entry each pair adds to."""
        n, none = self.n, np.iinfo(np.int64).max
        one, other = (self._unknowns[side] for side in self._pairs)
        low, high = np.minimum(one, other), np.maximum(one, other)
        key = np.where(low >= 0, low * np.int64(n) + high, none)
        # Pairs without unknowns all add to one entry behind the last.
        kept, entry = np.unique(np.append(key, none), return_inverse=True)
        kept = kept[:-1]
        starts = np.searchsorted(kept // n, np.arange(n + 1))
        return (kept % n).astype(np.int32), starts.astype(np.int32), entry[:-1]

    def packed(self, elements: FloatArray) -> FloatArray:
        """Return the lower triangles (p, m) of symmetric element matrices (m, k, k)."""
        return np.stack([elements[:, i, j] for i, j in zip(*self._pairs, strict=True)])

    def normal(self, jacobian: FloatArray) -> FloatArray:
        """Return the lower triangles (p, m) of J^T J, for J (m, r, k)."""
        rows = [jacobian[:, r].T for r in range(jacobian.shape[1])]
        return np.stack(
            [sum(row[i] * row[j] for row in rows) for i, j in zip(*self._pairs, strict=True)]
        )

    def lower(self, packed: FloatArray) -> csc_array:
        """Return the lower triangle (n, n) of the sum of element matrices."""
        rows, starts, entry = self._pattern
        values = np.bincount(entry, packed.reshape(-1), len(rows) + 1)[:-1]
        return csc_array((values, rows, starts), shape=(self.n, self.n))

    def vector(self, elements: FloatArray) -> FloatArray:
        """Return the (n,) sum of element vectors (m, k)."""
        # -1 becomes 0, which is left out.
        sums = np.bincount(self._unknowns.reshape(-1) + 1, elements.T.reshape(-1), self.n + 1)
        return np.asarray(sums[1:])

    def gathered(self, vector: FloatArray) -> FloatArray:
        """Return the (m, k) values of a vector (n,) in each element; 0 for none."""
        return np.asarray(np.append(vector, 0.0)[self._unknowns].T)
