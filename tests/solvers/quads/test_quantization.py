"""Quantisation: identities, brute force on small layouts, whole numbers kept whole."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest

from solvers.errors import CrossviewError
from solvers.layouts.tmesh import TMesh
from solvers.quads.collapse import broken, least_counts
from solvers.quads.integer_program import balances
from solvers.quads.quantization import fewest_quads, quantize, quantize_to
from tests.solvers.quads.tilings import ONE, PINWHEEL, cube, dissection, tiling, torus

RING = tiling([(0.0, 0.0, 3.1, 1.2), (3.1, 0.0, 6.3, 1.2)], period=6.3)
LAYOUTS: dict[str, TMesh] = {
    "one": tiling(ONE),
    "pinwheel": tiling(PINWHEEL),
    "ring": RING,
    "cube": cube(),
    "torus": torus(),
    "dissection": tiling(dissection(1, 40)),
    "L": tiling([(0, 0, 2, 1.1), (2, 0, 3.7, 1.1), (0, 1.1, 2, 3)]),
}


def deviation(t: TMesh, counts: np.ndarray, edge_length: float) -> float:
    """Of arcs, in edge lengths."""
    return float(np.abs(counts - t.lengths / edge_length).sum())


@pytest.mark.parametrize("name", LAYOUTS)
@pytest.mark.parametrize("edge_length", [0.07, 0.4, 3.0])
def test_opposite_sides_are_equal_and_nothing_is_broken(name: str, edge_length: float) -> None:
    t = LAYOUTS[name]
    found = quantize(t, edge_length)
    sides = t.side_totals(found.counts.astype(float))
    assert (sides[:, :2] == sides[:, 2:]).all()
    assert (found.counts >= 0).all()
    assert not broken(t, found.counts)
    assert found.n_quads == (sides[:, 0] * sides[:, 1]).sum()
    assert found.deviation == pytest.approx(deviation(t, found.counts, edge_length))


@pytest.mark.parametrize("name", LAYOUTS)
def test_whole_lengths_are_kept(name: str) -> None:
    t = LAYOUTS[name]
    whole = quantize(t, 0.3).counts
    scaled = replace(t, lengths=np.asarray(0.25 * whole))
    again = quantize(scaled, 0.25)
    assert (again.counts == whole).all()
    assert again.deviation == pytest.approx(0, abs=1e-9)


@pytest.mark.parametrize("name", ["one", "ring", "L", "torus"])
@pytest.mark.parametrize("edge_length", [0.7, 1.1, 1.6])
def test_no_counts_are_nearer_than_those_found(name: str, edge_length: float) -> None:
    t = LAYOUTS[name]
    wanted, least, balance = t.lengths / edge_length, least_counts(t), balances(t)
    near = [
        range(max(int(low), int(np.floor(w)) - 1), max(int(low), int(w) + 2) + 1)
        for w, low in zip(wanted, least, strict=True)
    ]
    every = np.array(list(product(*near)))
    every = every[(balance @ every.T == 0).all(axis=0)]
    every = every[[not broken(t, counts) for counts in every]]
    best = min(deviation(t, counts, edge_length) for counts in every)
    assert quantize(t, edge_length).deviation == pytest.approx(best, abs=1e-9)


def test_the_cube_keeps_its_symmetry() -> None:
    assert (quantize(cube(), 0.2).counts == 5).all()
    assert quantize_to(cube(), 5000).n_quads == 6 * 29**2


@pytest.mark.parametrize("name", LAYOUTS)
@pytest.mark.parametrize("n", [300, 5000])
def test_a_wanted_number_is_met_within_a_row_of_quads(name: str, n: int) -> None:
    found = quantize_to(LAYOUTS[name], n)
    assert abs(found.n_quads - n) < 3 * np.sqrt(n)


def test_no_edge_of_quads_has_the_same_ends_twice() -> None:
    assert (quantize(torus(), 100.0).counts == 3).all()
    assert sorted(quantize(RING, 100.0).counts.tolist()) == [1, 1, 1, 1, 2, 2]


def test_the_same_layout_gives_the_same_counts() -> None:
    t = LAYOUTS["dissection"]
    assert (quantize(t, 0.31).counts == quantize(t, 0.31).counts).all()


@pytest.mark.parametrize("name", LAYOUTS)
def test_where_fewer_are_wanted_than_possible_the_least_is_told(name: str) -> None:
    t = LAYOUTS[name]
    found, fewest = quantize_to(t, 1), fewest_quads(t).n_quads
    assert found.n_wanted == 1
    assert found.n_quads == fewest
    assert found.missed == (fewest > 1)
    assert found.n_fewest == (fewest if fewest > 1 else None)
    met = quantize_to(t, 1000)
    assert not met.missed
    assert met.n_fewest is None


def test_the_fewest_quads_of_small_layouts_are_known() -> None:
    """One for a square, one for each side of a cube, three by three on a torus."""
    known = {"one": 1, "L": 3, "cube": 6, "torus": 9}
    assert {name: fewest_quads(LAYOUTS[name]).n_quads for name in known} == known


@pytest.mark.parametrize("edge_length", [0.0, -1.0, np.nan, np.inf, 1e-9])
def test_edge_lengths_that_make_no_mesh_are_refused(edge_length: float) -> None:
    with pytest.raises(CrossviewError, match="edge"):
        quantize(LAYOUTS["one"], edge_length)


def test_numbers_of_quads_that_make_no_mesh_are_refused() -> None:
    for n in (0, -3, 10**9, 20.5, True):
        with pytest.raises(CrossviewError, match="number of quads must be a whole number from 1"):
            quantize_to(LAYOUTS["one"], n)  # type: ignore[arg-type]
