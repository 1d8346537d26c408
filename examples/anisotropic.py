"""Singularities that stay where they are: two sizes where one size misses a boundary.

Four valence 3 and, on another circle of an annulus, four valence 5 that are turned against them by
15 degrees. By just as much an isotropic field misses one of the boundaries.
"""

import numpy as np

import crossview
from crossview import Problem, Singularity, primitives

surface = primitives.annulus(inner=0.4, n=72)


def ring(valence: int, radius: float, turned: float) -> list[Singularity]:
    """Place four of a valence on a circle, turned by some degrees."""
    angles = np.radians(turned + np.arange(0, 360, 90))
    places = radius * np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=1)
    return [Singularity(surface.closest_point(place), valence) for place in places]


problem = Problem(surface, ring(3, 0.8, 0) + ring(5, 0.6, 15))
misaligned = {}
for method in ("isotropic", "aligned", "anisotropic"):
    solution = crossview.solve(problem, method)
    field = solution.field
    misaligned[method] = off = np.degrees(np.abs(field.boundary_misalignment).max())
    print(f"{method:12} {off:4.1f} degrees off, E {field.energy:.1e}: {solution.verdict.status}")
    print(" " * 12, solution.verdict.reason)

crossview.render(solution, "aspect.png", layers=["aspect", "separatrices", "singularities"])
