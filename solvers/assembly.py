"""Sparse matrices summed from element matrices, on a pattern that is found once."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csc_array

from solvers.triangulation import FloatArray, IntArray


class ElementAssembly:
    """Sums of symmetric element matrices over shared unknowns.

    Parameters
    ----------
    unknowns : (m, k) int array
        The unknown behind each row of each element matrix; -1 for none.
    n : int
        Number of unknowns.
    """

    def __init__(self, unknowns: IntArray, n: int) -> None:
        self.n = n
        self._unknowns = unknowns
        k = unknowns.shape[1]
        rows, columns = unknowns[:, :, None], unknowns[:, None, :]
        self._kept = ((rows >= 0) & (columns >= 0)).reshape(-1)
        key = (columns * np.int64(n) + rows).reshape(-1)[self._kept]
        pattern, self._entry = np.unique(key, return_inverse=True)
        self._rows = (pattern % n).astype(np.int32)
        self._starts = np.searchsorted(pattern // n, np.arange(n + 1)).astype(np.int32)
        self._shape = (len(unknowns), k)

    def matrix(self, elements: FloatArray) -> csc_array:
        """Return the (n, n) sum of element matrices (m, k, k)."""
        values = np.bincount(self._entry, elements.reshape(-1)[self._kept], len(self._rows))
        return csc_array((values, self._rows, self._starts), shape=(self.n, self.n))

    def vector(self, elements: FloatArray) -> FloatArray:
        """Return the (n,) sum of element vectors (m, k)."""
        used = self._unknowns >= 0
        return np.asarray(np.bincount(self._unknowns[used], elements[used], self.n))

    def gathered(self, vector: FloatArray) -> FloatArray:
        """Return the (m, k) values of a vector (n,) in each element; 0 for none."""
        return np.where(self._unknowns >= 0, vector[self._unknowns], 0.0)
