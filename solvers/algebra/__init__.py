"""Finite element matrices, their assembly, and the one place that solves with them."""

from __future__ import annotations

from solvers.algebra.factorization import Analysis, Factorization, factorized
from solvers.algebra.lanczos import ritz_vectors
from solvers.algebra.mixing import AndersonMixing
from solvers.algebra.operators import crouzeix_raviart, laplacian, lumped_mass, stiffness

__all__ = [
    "Analysis",
    "AndersonMixing",
    "Factorization",
    "crouzeix_raviart",
    "factorized",
    "laplacian",
    "lumped_mass",
    "ritz_vectors",
    "stiffness",
]
