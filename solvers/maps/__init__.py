"""Seamless maps: a field integrated to images of edges, consistent up to quarter turns."""

from __future__ import annotations

from solvers.maps.closed_images import SeamlessMap
from solvers.maps.folds import MappedField, unfolded, with_possible_turns
from solvers.maps.matching import Matching
from solvers.maps.release import by_release
from solvers.maps.seamless import seamless_map

__all__ = [
    "MappedField",
    "Matching",
    "SeamlessMap",
    "by_release",
    "seamless_map",
    "unfolded",
    "with_possible_turns",
]
