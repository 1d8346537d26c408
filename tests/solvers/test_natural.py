"""Natural singularities: the budget always, and the anticube on the sphere."""

import numpy as np
import pytest

from solvers.errors import CrossviewError
from solvers.natural import METHODS, natural_singularities
from solvers.primitives import BUILTIN
from solvers.progress import run
from solvers.singularities import default_corners, index_budget
from tests.solvers.suite import SURFACES


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("name", SURFACES)
def test_indices_sum_to_the_budget(name: str, method: str) -> None:
    surface = SURFACES[name]()
    found = run(natural_singularities(surface, method))
    assert index_budget(surface, found, default_corners(surface)).satisfied
    positions = surface.positions([s.point for s in found])
    boundary = surface.vertices[surface.boundary_vertices]
    if len(found) and len(boundary):
        assert np.linalg.norm(positions[:, None] - boundary, axis=2).min() > 0


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("name", ["square", "annulus", "cylinder"])
def test_no_singularity_where_none_is_needed(name: str, method: str) -> None:
    assert run(natural_singularities(SURFACES[name](), method)) == ()


def anticube() -> np.ndarray:
    """The corners of the square antiprism that eight equal charges take on the sphere."""
    latitude = np.radians(34.1)
    angles = np.pi / 2 * np.arange(4)
    rings = [
        (np.cos(latitude) * np.cos(a + turn), np.cos(latitude) * np.sin(a + turn), sign)
        for turn, sign in ((0, 1), (np.pi / 4, -1))
        for a in angles
    ]
    return np.array([(x, y, sign * np.sin(latitude)) for x, y, sign in rings])


def misfit(points: np.ndarray) -> float:
    """Degrees by which the sorted mutual angles differ from those of the anticube."""

    def angles(x: np.ndarray) -> np.ndarray:
        cosine = np.clip(x @ x.T, -1, 1)[np.triu_indices(len(x), 1)]
        return np.sort(np.degrees(np.arccos(cosine)))

    return float(np.abs(angles(points) - angles(anticube())).mean())


@pytest.mark.parametrize("method", ["mbo", "ginzburg-landau"])
def test_the_sphere_has_the_anticube(method: str) -> None:
    surface = BUILTIN["sphere"](subdivisions=4)
    fits = []
    for seed in range(3):
        found = run(natural_singularities(surface, method, seed))
        assert [s.valence for s in found] == [3] * 8
        points = surface.positions([s.point for s in found])
        fits.append(misfit(points / np.linalg.norm(points, axis=1)[:, None]))
    assert max(fits) < 2.5


def test_an_unknown_method_is_refused() -> None:
    with pytest.raises(CrossviewError, match="one of mbo, ginzburg-landau, globally-optimal"):
        run(natural_singularities(SURFACES["disk"](), "best"))
