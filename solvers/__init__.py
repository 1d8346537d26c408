"""Integrable cross-fields on triangle surfaces with imposed singularities.

Numerics only: NumPy and SciPy, no window and no file formats. Start with `TriSurface`, place
`Singularity` values on it, and give them to `IsotropicSolver`.
"""
