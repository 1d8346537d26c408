"""Arcs without quads: topology and singularities stay, whatever is collapsed."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import LinearConstraint, milp

from solvers.errors import CrossviewError
from solvers.layouts.tmesh import TMesh
from solvers.quads.collapse import broken
from solvers.quads.integer_program import balances
from solvers.quads.quantization import quantize, quantize_to
from tests.solvers.quads.tilings import PINWHEEL, assembled, cube, dissection, tiling, torus
from tests.solvers.suite import SURFACES


def sheet(seed: int, n: int, critical: int) -> TMesh:
    """A dissection with some inner nodes taken for singularities."""
    t = tiling(dissection(seed, n))
    inner = np.flatnonzero(~t.node_on_boundary)
    kept = t.critical.copy()
    kept[np.random.default_rng(seed).choice(inner, critical, replace=False)] = True
    return replace(t, critical=kept)


def ring(seed: int, n: int) -> TMesh:
    return tiling(dissection(seed, n), period=7.0)


LAYOUTS = {
    **{f"sheet {i}": (sheet(i, 6 + 3 * i, i), "square") for i in (1, 3, 4)},
    **{f"ring {i}": (ring(i, 2 + 2 * i), "annulus") for i in (1, 3)},
    "pinwheel": (tiling(PINWHEEL, critical=[(3.2, 2.3), (6.1, 5.2)]), "square"),
    "cube": (cube(), "sphere"),
    "torus": (torus(), "torus"),
}


def is_whole(t: TMesh, counts: np.ndarray, name: str) -> bool:
    """Whether the quads are a mesh with the surface's topology and the layout's singularities."""
    if not (t.side_totals(counts.astype(float))[:, :2] > 0).all(axis=1).any():
        return False
    mesh = assembled(t, counts, SURFACES[name]())
    try:
        mesh.check()
    except CrossviewError:
        return False
    inner = t.critical & ~t.node_on_boundary
    return bool(
        np.count_nonzero(mesh.fixed) == np.count_nonzero(t.critical)
        and np.count_nonzero(mesh.fixed & (mesh.boundary_loop < 0)) == np.count_nonzero(inner)
    )


@pytest.mark.parametrize("name", LAYOUTS)
def test_what_is_broken_is_told_and_nothing_else(name: str) -> None:
    t, surface = LAYOUTS[name]
    rng = np.random.default_rng(7)
    seen = set()
    for _ in range(30):
        scale = rng.choice([0.3, 0.6, 1.0, 2.0])
        found = milp(
            rng.normal(size=t.n_arcs),
            integrality=np.ones(t.n_arcs),
            bounds=(0, rng.integers(0, 4, t.n_arcs) * (rng.random(t.n_arcs) < scale) + 1),
            constraints=[LinearConstraint(balances(t), 0, 0)] if balances(t).shape[0] else [],
        )
        counts = np.rint(found.x).astype(np.int64)
        told = broken(t, counts)
        assert (not told) == is_whole(t, counts, surface)
        for cut in told:
            assert counts[cut.arcs].sum() < cut.least
            assert cut.least > 1 or len(cut.arcs) > 0
        seen.add(bool(told))
    assert True in seen


@pytest.mark.parametrize("name", LAYOUTS)
@pytest.mark.parametrize("edge_length", [0.3, 1.0, 2.5, 30.0])
def test_numbers_make_meshes_with_the_same_singularities(name: str, edge_length: float) -> None:
    t, surface = LAYOUTS[name]
    found = quantize(t, edge_length)
    assert is_whole(t, found.counts, surface)
    sides = t.side_totals(found.counts.astype(float))
    assert (sides[:, :2] == sides[:, 2:]).all()


def test_coarse_meshes_let_arcs_vanish() -> None:
    t, surface = LAYOUTS["sheet 3"]
    coarse = quantize_to(t, 1)
    assert coarse.n_quads < t.n_rectangles
    assert (coarse.counts == 0).any()
    assert is_whole(t, coarse.counts, surface)


def test_singularities_that_nearly_coincide_stay_apart() -> None:
    """Two rectangles side by side, a thin one between them with a singularity on either side."""
    t = tiling(
        [
            (0, 0, 3, 2),
            (0, 2, 3, 4),
            (3, 0, 3.01, 2),
            (3, 2, 3.01, 4),
            (3.01, 0, 6, 2),
            (3.01, 2, 6, 4),
        ],
        critical=[(3, 2), (3.01, 2)],
    )
    thin = np.flatnonzero(t.lengths < 0.1)
    assert (quantize(t, 1.0).counts[thin] == 1).all()
    alone = tiling(
        [
            (0, 0, 3, 2),
            (0, 2, 3, 4),
            (3, 0, 3.01, 2),
            (3, 2, 3.01, 4),
            (3.01, 0, 6, 2),
            (3.01, 2, 6, 4),
        ],
        critical=[(3, 2)],
    )
    assert (quantize(alone, 1.0).counts[thin] == 0).all()


def test_singularities_on_two_sides_of_a_thin_strip_may_slide_past_each_other() -> None:
    """They are three edges apart along the strip, which vanishes."""
    t = tiling(
        [(0, 0, 3, 2), (3, 0, 6, 2), (0, 2, 6, 2.01), (0, 2.01, 1, 4), (1, 2.01, 6, 4)],
        critical=[(3, 2), (1, 2.01)],
    )
    found = quantize(t, 0.7)
    assert (found.counts[t.lengths < 0.1] == 0).all()
    assert is_whole(t, found.counts, "square")
