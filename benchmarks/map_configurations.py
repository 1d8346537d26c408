"""Valid configurations drawn at random, and one singularity of each valence."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from benchmarks.make_valid import drawn_places, plate
from crossview import Problem, Singularity, make_valid
from solvers.primitives import BUILTIN
from solvers.progress import run
from solvers.singularities.budget import default_corners
from solvers.singularities.farthest import far_points
from solvers.surface.trisurface import TriSurface

Make = Callable[[np.random.Generator], TriSurface]

FAMILIES: dict[str, Make] = {
    "annulus": lambda rng: BUILTIN["annulus"](inner=float(rng.uniform(0.25, 0.7)), n=64),
    "plate": lambda rng: plate(int(rng.integers(1, 5)))(rng),
    "torus": lambda rng: BUILTIN["torus"](minor=float(rng.uniform(0.3, 0.6)), n=48),
    "genus 2": lambda _: BUILTIN["genus"](handles=2, subdivisions=2),
    "sphere": lambda _: BUILTIN["sphere"](subdivisions=4),
}
EACH = 40
"""Configurations of each family."""

VALENCES = range(1, 25)
MESHES = {"coarse": 3, "fine": 5}
"""Subdivisions of the sphere that each valence is tried on."""


@dataclass(frozen=True)
class Drawn:
    """A random configuration, not yet valid: of its family the one of that seed."""

    family: str
    seed: int

    def problem(self) -> Problem:
        """Return it with its singularities moved to where they are valid."""
        rng = np.random.default_rng([sum(map(ord, self.family)), self.seed, 10])
        surface = FAMILIES[self.family](rng)
        conditions = 2 * surface.genus + max(len(surface.boundary_loops) - 1, 0)
        missing = 4 * surface.euler_characteristic - sum(default_corners(surface).values())
        valences = [3, 5]
        while sorted(valences) == [3, 5]:  # impossible on a torus
            valences = drawn_valences(missing, 2 + conditions, rng)
        places = drawn_places(surface, len(valences), rng)
        drawn = tuple(Singularity(p, v) for p, v in zip(places, valences, strict=True))
        return make_valid(Problem(surface, drawn))


def drawn_valences(missing: int, least: int, rng: np.random.Generator) -> list[int]:
    """At least so many of 2 to 12, mostly 3 and 5, with indices that sum to what is missing."""
    common, rare = [3, 5], [2, 6, 7, 8, 9, 10, 11, 12]
    most = 8 + abs(missing)
    while True:
        count = least + int(rng.integers(0, 4))
        odd = rng.random(count) < 0.3
        drawn = np.where(odd, rng.choice(rare, count), rng.choice(common, count))
        left = missing - int((4 - drawn).sum())
        if abs(left) + count <= most + least:
            return [*drawn.tolist(), *[3 if left > 0 else 5] * abs(left)]


@dataclass(frozen=True)
class OfValence:
    """One singularity of a valence on a sphere, as many of valence 3 or 5 as it needs far off."""

    mesh: str
    valence: int

    def problem(self) -> Problem:
        """Return it."""
        ball = BUILTIN["sphere"](subdivisions=MESHES[self.mesh])
        first = Singularity(ball.point_at_vertex(100), self.valence)
        left = 8 - first.index
        places = run(far_points(ball, (first,), abs(left)))
        return Problem(ball, (first, *(Singularity(p, 3 if left > 0 else 5) for p in places)))


def drawn() -> Iterator[Drawn]:
    """All random configurations."""
    for family in FAMILIES:
        for seed in range(EACH):
            yield Drawn(family, seed)


def of_valences() -> Iterator[OfValence]:
    """All valences on all meshes."""
    for mesh in MESHES:
        for valence in VALENCES:
            yield OfValence(mesh, valence)
