"""Cross-fields with imposed singularities on triangulated surfaces (NumPy and SciPy only)."""
