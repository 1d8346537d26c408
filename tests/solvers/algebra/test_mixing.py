"""Anderson mixing: affine maps are solved exactly, and it is a Krylov method on them."""

import numpy as np
import pytest
from scipy.sparse.linalg import gmres

from solvers.algebra.mixing import DEPTH, AndersonMixing


def affine(n: int, radius: float) -> tuple[np.ndarray, np.ndarray]:
    """A map x -> A x + b whose A is symmetric and has its largest eigenvalue there."""
    rng = np.random.default_rng(n)
    q = np.linalg.qr(rng.normal(size=(n, n)))[0]
    return (q * np.linspace(0.1, radius, n)) @ q.T, rng.normal(size=n)


@pytest.mark.parametrize("radius", [0.999, 3.0])
def test_an_affine_map_takes_one_step_more_than_it_has_dimensions(radius: float) -> None:
    a, b = affine(DEPTH, radius)
    mixing, x = AndersonMixing(np.ones(DEPTH)), np.zeros(DEPTH, dtype=complex)
    for _ in range(DEPTH + 1):
        x = mixing.mixed(x, a @ x + b)
    exact = np.linalg.solve(np.eye(DEPTH) - a, b)
    assert np.linalg.norm(x - exact) < 1e-6 * np.linalg.norm(exact)


def test_residuals_are_as_small_as_those_of_gmres() -> None:
    n = 40
    a, b = affine(n, 0.9)
    mixing, x = AndersonMixing(np.ones(n)), np.zeros(n, dtype=complex)
    for k in range(1, DEPTH + 1):
        before, image = x, a @ x + b
        x = mixing.mixed(before, image)
        # Walker and Ni: the step after k images is the image of the k-th iterate of GMRES, k - 1.
        krylov = np.zeros(n)
        if k > 1:
            krylov = gmres(np.eye(n) - a, b, rtol=0, atol=0, restart=k - 1, maxiter=1)[0]
        assert np.allclose(x, a @ krylov + b, atol=1e-7)


def test_real_coefficients_keep_what_is_linear_over_real_numbers() -> None:
    rng = np.random.default_rng(0)
    mixing, x = AndersonMixing(rng.random(6)), np.ones(6, dtype=complex)
    half = x[:3]
    x = np.concatenate([half, half.conj()])  # a mirror image
    for _ in range(8):
        x = mixing.mixed(x, np.concatenate([np.cos(x[:3]), np.cos(x[3:])]))
        assert np.allclose(x[:3], x[3:].conj(), atol=1e-14)
