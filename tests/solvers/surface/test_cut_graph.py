"""The cut graph opens the surface to a disk and meets every singularity."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from solvers.fields.isotropic import IsotropicSolver
from solvers.surface.triangulation import next_halfedge
from tests.solvers.suite import SURFACES, random_configuration


@pytest.mark.parametrize("name", SURFACES)
@pytest.mark.parametrize("seed", [0, 1])
def test_cutting_leaves_one_disk(name: str, seed: int) -> None:
    surface = SURFACES[name]()
    singularities = random_configuration(surface, seed)
    cut = IsotropicSolver(surface).cut_graph(singularities)
    t = surface.triangulation
    edges = {frozenset(e) for e in cut.tolist()}
    assert len(edges) == len(cut)
    is_cut = np.array([frozenset(e) in edges for e in surface.edges.tolist()])
    inner = surface.edge_faces[:, 1] >= 0
    assert not (is_cut & ~inner).any()
    # Glue the triangles over the edges that are left, and their corners across those edges.
    left, right = surface.edge_faces[inner & ~is_cut].T
    ones = np.ones(len(left))
    graph = coo_array((ones, (left, right)), shape=(surface.n_faces,) * 2)
    assert connected_components(graph, directed=False)[0] == 1
    h = t.edge_halfedges[inner & ~is_cut]
    g = t.twin[h]
    rows = np.concatenate([h, next_halfedge(h)])
    columns = np.concatenate([next_halfedge(g), g])
    corners = coo_array((np.ones(len(rows)), (rows, columns)), shape=(len(t.twin),) * 2)
    n_vertices = connected_components(corners, directed=False)[0]
    n_edges = inner.sum() + is_cut.sum() + (~inner).sum()
    assert n_vertices - n_edges + surface.n_faces == 1
    singular = {
        int(surface.faces[s.point.face, int(np.argmax(s.point.barycentric))]) for s in singularities
    }
    assert singular <= set(cut.ravel().tolist())


@pytest.mark.parametrize("name", ["torus", "torus_with_hole", "double_torus"])
def test_handle_loops_are_closed_paths_along_edges(name: str) -> None:
    surface = SURFACES[name]()
    conditions = IsotropicSolver(surface).holonomy.conditions
    edges = {frozenset(e) for e in surface.edges.tolist()}
    loops = [c for c in conditions if c.kind == "loop"]
    assert len(loops) == 2 * surface.genus
    for condition in loops:
        path = condition.path.tolist()
        assert path[0] == path[-1]
        assert all(frozenset(e) in edges for e in pairwise(path))


def test_the_loops_of_a_torus_are_nearly_the_shortest_through_a_vertex() -> None:
    surface = SURFACES["torus"]()
    lengths = []
    for condition in IsotropicSolver(surface).holonomy.conditions:
        p = surface.vertices[condition.path]
        lengths.append(np.linalg.norm(np.diff(p, axis=0), axis=1).sum())
    around_tube, around_hole = sorted(lengths)
    assert around_tube < 1.2 * 2 * np.pi * 0.4
    assert around_hole < 1.1 * 2 * np.pi * 1.0
