"""Bounds on long edges: arcs ask for what their length does, and what is met keeps means short."""

from collections.abc import Sequence

import numpy as np
import pytest

from solvers.errors import CrossviewError
from solvers.layouts.layout import QuadLayout, quad_layout
from solvers.primitives import BUILTIN
from solvers.progress import run
from solvers.quads.collapse import Condition
from solvers.quads.quantization import quantize_to
from solvers.quads.sizing import size_conditions
from solvers.quads.stretches import polylines
from solvers.surface.triangulation import FloatArray
from tests.solvers.layouts.fields import at_places, integrated, layout_of


def lengths(layout: QuadLayout) -> FloatArray:
    every = np.arange(layout.tmesh.n_arcs)
    return np.array([line.lengths.sum() for line in polylines(layout, every)], dtype=float)


@pytest.mark.parametrize("name", ["square", "disk with four", "ring of eight", "cube sphere"])
@pytest.mark.parametrize("share", [0.01, 0.1, 1.0])
def test_conditions_ask_for_the_whole_edges_nearest_to_lengths_each_arc_once(
    name: str, share: float
) -> None:
    layout = layout_of(name)
    length = lengths(layout)
    longest = share * length.max()
    asked = np.zeros(len(length), dtype=int)
    for condition in size_conditions(layout, longest):
        asked[condition.arcs] += 1
        together = length[condition.arcs].sum() / longest
        if len(condition.arcs) == 1:
            assert abs(together - condition.least) <= 0.5 + 1e-6
        else:
            assert condition.least == 1 <= together + 1e-6 < 2 + 1e-6
    assert asked.max() == 1
    assert (asked[length >= longest] == 1).all()


def test_on_the_unit_sphere_edges_turn_by_their_length() -> None:
    layout = layout_of("cube sphere")
    every = np.arange(layout.tmesh.n_arcs)
    for line in polylines(layout, every):
        assert line.turns.sum() == pytest.approx(line.lengths.sum(), rel=0.01)
    asked = size_conditions(layout, 100.0, np.radians(10))
    same = size_conditions(layout, 0.99 * np.radians(10))
    assert [c.least for c in asked] == [c.least for c in same]
    assert sum(c.least for c in asked) > len(every)


def test_flat_land_asks_for_nothing_by_its_turns() -> None:
    layout = layout_of("ring of eight")
    assert size_conditions(layout, 2 * float(lengths(layout).sum()), 0.01) == []


def test_nothing_is_asked_where_all_is_short() -> None:
    layout = layout_of("ring of eight")
    assert size_conditions(layout, 2 * float(lengths(layout).sum())) == []


def test_edges_along_an_arc_are_on_average_no_longer() -> None:
    """On an annulus whose sizes span 30 and more, where they would be 5 times longer."""
    surface = BUILTIN["annulus"](inner=0.4)
    places = at_places(surface, [[0.8, 0, 0], [-0.6, 0, 0]], [3, 5])
    layout = run(quad_layout(integrated(surface, places)))
    longest = 4 * np.sqrt(surface.area / 1500)
    alone = lengths(layout) > longest

    def means(conditions: Sequence[Condition]) -> FloatArray:
        chosen = quantize_to(layout.tmesh, 1500, conditions=conditions)
        assert not chosen.missed
        return np.asarray(lengths(layout)[alone] / np.maximum(chosen.counts[alone], 1))

    assert means([]).max() > 1.4 * longest
    assert means(size_conditions(layout, longest)).max() < 2 * longest
    assert means(size_conditions(layout, longest)).max() < 0.8 * means([]).max()


def test_a_length_is_positive() -> None:
    for wrong in (0.0, -1.0, np.nan):
        with pytest.raises(CrossviewError, match="longest edge"):
            size_conditions(layout_of("square"), wrong)
