"""Impose singularities on a surface, solve its boundary-aligned cross-field, and see it live."""

from importlib.metadata import version

__version__ = version("crossview")
