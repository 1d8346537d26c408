"""Fixed points in fewer steps: Anderson mixing."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from solvers.surface.triangulation import FloatArray

ComplexArray = npt.NDArray[np.complex128]

DEPTH = 5
"""Differences that are remembered. Measured: ten save no more steps, and take room."""

GROWTH = 2.0
"""By how much the residual may grow before what is remembered is forgotten. Chosen."""

INDEPENDENT = 1e-10
"""Least eigenvalue of differences' Gram matrix that counts, in parts of the largest. Chosen."""


class AndersonMixing:
    """Where to go on from, so that a fixed point of x -> g(x) is met sooner than by x = g(x).

    It goes to the combination of the last images whose residual g(x) - x would be least, were g
    affine. It meets any fixed point, a repelling one also, so that it is of use once x is near the
    one that is wanted.

    Parameters
    ----------
    weights : (n,) float array
        Of squares in the norm of a residual; not negative.

    Notes
    -----
    Anderson 1965; Walker and Ni 2011, of type II, with real coefficients.

    Examples
    --------
    In the plane two differences span all, so that an affine map takes three steps:

    >>> import numpy as np
    >>> from solvers.algebra import AndersonMixing
    >>> slope, at = np.array([[0.9, 0.5], [-0.2, 0.95]]), np.ones(2)
    >>> mixing, x = AndersonMixing(np.ones(2)), np.array([5.0 + 0j, 3.0])
    >>> for _ in range(3):
    ...     x = mixing.mixed(x, at + slope @ (x - at))
    >>> bool(np.allclose(x, at))
    True
    """

    def __init__(self, weights: FloatArray) -> None:
        self._root = np.sqrt(weights)
        self._last: tuple[ComplexArray, FloatArray] | None = None
        self._images: list[ComplexArray] = []
        self._residuals: list[FloatArray] = []

    def mixed(self, x: ComplexArray, image: ComplexArray) -> ComplexArray:
        """Return where to take the next image.

        Parameters
        ----------
        x : (n,) complex array
            Where the last one was taken.
        image : (n,) complex array
            It.
        """
        residual = np.ascontiguousarray((image - x) * self._root).view(np.float64)
        if self._last is not None:
            last_image, last = self._last
            if np.linalg.norm(residual) > GROWTH * np.linalg.norm(last):
                self._images, self._residuals = [], []
            else:
                self._images = [*self._images, image - last_image][-DEPTH:]
                self._residuals = [*self._residuals, residual - last][-DEPTH:]
        self._last = image, residual
        if not self._images:
            return image
        differences = np.stack(self._residuals)
        gram = differences @ differences.T
        share = np.linalg.lstsq(gram, differences @ residual, rcond=INDEPENDENT)[0]
        return np.asarray(image - np.tensordot(share, np.stack(self._images), 1))
