"""The largest eigenvalue of an operator that is known by what it does: Lanczos."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
from scipy.linalg import eigh_tridiagonal

from solvers.surface.triangulation import FloatArray

BASIS = 30
"""Vectors that are kept before a start from the best combination of them. Chosen: 30 of them take
about the room of a factor.
"""


def ritz_vectors(
    apply: Callable[[FloatArray], FloatArray], start: FloatArray
) -> Iterator[tuple[FloatArray, float]]:
    """Come ever closer to the largest eigenvalue of a positive definite operator.

    Each approximation costs one application, and one is made for as long as one is asked for.

    Parameters
    ----------
    apply : callable
        From a (n,) float array to another; symmetric, positive definite.
    start : (n,) float array
        Not zero, nor orthogonal to what is looked for.

    Yields
    ------
    vector : (n,) float array
        Of unit norm.
    residual : float
        Norm of A x - lambda x, relative to lambda, its Rayleigh quotient. An eigenvalue is as near
        as that, and the largest, once it is well separated, nearer by a square.

    Notes
    -----
    Lanczos 1950, made orthogonal to all before twice, and started anew from its Ritz vector.

    Examples
    --------
    >>> import numpy as np
    >>> from solvers.algebra import ritz_vectors
    >>> sizes = np.arange(1.0, 21.0)
    >>> for vector, residual in ritz_vectors(lambda x: sizes * x, np.ones(20)):
    ...     if residual < 1e-9:
    ...         break
    >>> int(np.abs(vector).argmax()), round(float(vector @ (sizes * vector)), 9)
    (19, 20.0)
    """
    while True:
        basis = np.empty((min(BASIS, len(start)), len(start)))
        along, beside = np.zeros(len(basis)), np.zeros(len(basis))
        following = start / np.linalg.norm(start)
        for k in range(len(basis)):
            basis[k] = following
            known = basis[: k + 1]
            following = apply(following)
            along[k] = basis[k] @ following
            for _ in range(2):
                following = following - (known @ following) @ known
            beside[k] = np.linalg.norm(following)
            values, vectors = eigh_tridiagonal(along[: k + 1], beside[:k])
            start = vectors[:, -1] @ known
            yield start, float(beside[k] * abs(vectors[-1, -1]) / values[-1])
            if beside[k] == 0:
                break
            following = following / beside[k]
