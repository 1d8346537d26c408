"""Nodes that separatrices nearly meet are put on them: within a degree, and not by accident."""

import pytest

from solvers.layouts.connections import passing
from solvers.layouts.crossings import crossings
from solvers.layouts.joined_map import JoinedMap
from solvers.layouts.layout import quad_layout
from solvers.layouts.nodes import singular_nodes, starts_at
from solvers.layouts.tracing import trace
from solvers.maps.seamless import SeamlessFit
from solvers.primitives import disk, sphere
from solvers.progress import run
from tests.solvers.layouts.fields import at_places, integrated
from tests.solvers.suite import separated


@pytest.mark.parametrize(
    ("off", "patches"), [(0.003, 5), (0.03, 5), (0.08, 5), (0.1, 9), (0.12, 9), (0.2, 9)]
)
def test_a_degree_off_the_line_is_on_it_and_more_is_not(off: float, patches: int) -> None:
    """A square of four in a disk with one moved along the circle: its sides part when it is far."""
    places = [[0.5, off, 0], [0, 0.5, 0], [-0.5, 0, 0], [0, -0.5, 0]]
    surface = disk(edge_length=0.08)
    layout = run(quad_layout(integrated(surface, at_places(surface, places, [3] * 4))))
    assert (layout.patches, layout.conforming) == (patches, True)


def random_passings(seed: int) -> tuple[int, int]:
    """How many separatrices leave 24 random places of a sphere, and how many are taken to meet."""
    surface = sphere(subdivisions=4)
    places = separated(surface, seed, [3] * 8 + [3, 5] * 8, 0.2)
    field = integrated(surface, places)
    map_ = JoinedMap(field, SeamlessFit(field))
    nodes = singular_nodes(map_.chart, map_.integrated.field)
    starts = starts_at(map_.chart, nodes)
    traces = trace(map_.chart, nodes, starts, 0.02, 4 * map_.chart.diameter)
    found = passing(traces, crossings(map_.chart, traces.chords), len(nodes))
    return len(traces.ends), len(found)


def test_of_random_places_one_in_five_at_most_is_met() -> None:
    """Few are by accident as near to a line as all that are put on one; half of them both ways."""
    leaving, met = (sum(counts) for counts in zip(*map(random_passings, range(3)), strict=True))
    assert leaving == 3 * (16 * 3 + 8 * 5)
    assert 0.1 * leaving < met < 0.2 * leaving
