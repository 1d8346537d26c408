"""Crossview: impose singularities on a surface, see the cross-field and whether it is valid."""

__version__ = "0.1.0"
