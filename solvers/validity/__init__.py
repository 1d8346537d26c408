"""Valid configurations: where a singularity may go, and the way to where it does."""

from __future__ import annotations

from solvers.validity.attempts import PlaceAnew, ValidityError, make_valid
from solvers.validity.completion import MOST_PLACED, missing_singularities
from solvers.validity.guide import Guide, LevelLines
from solvers.validity.improvement import Improved, improve
from solvers.validity.search import Moved
from solvers.validity.simplification import fewest_left, simplify
from solvers.validity.unevenness import Sizes, Unevenness

__all__ = [
    "MOST_PLACED",
    "Guide",
    "Improved",
    "LevelLines",
    "Moved",
    "PlaceAnew",
    "Sizes",
    "Unevenness",
    "ValidityError",
    "fewest_left",
    "improve",
    "make_valid",
    "missing_singularities",
    "simplify",
]
