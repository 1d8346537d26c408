"""Maps are checked on the triangles that they live on."""

import numpy as np

from benchmarks.map_check import check
from benchmarks.map_configurations import OfValence
from benchmarks.maps import connectivity_of, linear, page_of, wanted_quads
from benchmarks.poor_surfaces import polar_annulus
from crossview import Problem, solve
from solvers.maps import seamless_map


def test_a_repaired_map_is_right_on_its_own_triangles() -> None:
    solution = solve(OfValence("coarse", 13).problem(), method="anisotropic")
    assert solution.integrated is not None
    first, repaired = linear(solution.integrated), seamless_map(solution.integrated)
    assert not np.array_equal(
        first.matching.triangulation.faces, repaired.matching.triangulation.faces
    )
    for map_ in (first, repaired):
        connectivity, quads = connectivity_of(map_), wanted_quads(solution, map_)
        used = np.unique(connectivity.corners)
        assert (4 - quads[used]).sum() == 8  # Poincare and Hopf on a sphere
        assert check(connectivity, map_.images, quads).right == map_.upright
    assert repaired.upright
    assert not first.upright


def test_quads_are_wanted_on_boundaries_also_where_the_triangulation_is_finer() -> None:
    surface = polar_annulus(12, 40)
    solution = solve(Problem(surface), method="anisotropic")
    assert solution.integrated is not None
    map_ = seamless_map(solution.integrated)
    t, quads = map_.matching.triangulation, wanted_quads(solution, map_)
    assert t.n_vertices > surface.n_vertices
    border = np.unique(t.tail[t.twin < 0])
    assert (quads[border] == 2).all()
    assert (np.delete(quads, border) == 4).all()
    assert check(connectivity_of(map_), map_.images, quads).right


def test_the_page_tells_how_many_rows_were_run() -> None:
    every = [("cube of 2 cells", "plain"), ("cube of 2 cells", "features")]
    row = {"name": "cube of 2 cells", "way": "plain", "refused": "it", "stage": "read"}
    assert "1 of 2 rows run" in page_of([row], every)
