"""Singularities and corners: the index budget, pairs, symmetry, spacing."""
