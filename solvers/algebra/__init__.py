"""Finite element matrices, their assembly, and the one place that solves with them."""
