"""The direction of crosses that nothing fixes: that in which separatrices join singularities."""

from __future__ import annotations

from solvers.fields.crossfield import CrossField
from solvers.layouts.charts import QUARTER, Chart
from solvers.layouts.connections import best_turn
from solvers.layouts.crossings import crossings
from solvers.layouts.nodes import singular_nodes, starts_at
from solvers.layouts.tracing import trace

FAR = 1.5
"""Length of the curves that are looked at, in square roots of the area in the map."""


def joining_turn(field: CrossField) -> float:
    """Return the angle to turn all crosses by so that most neighbours lie on common lines.

    Parameters
    ----------
    field : CrossField
        With nothing that fixes its direction.

    Returns
    -------
    float
        Radians, in (-pi/4, pi/4].
    """
    chart = Chart.of_field(field)
    nodes = singular_nodes(chart, field)
    far = FAR * float(chart.area) ** 0.5
    traces = trace(chart, nodes, starts_at(chart, nodes), 0.0, far)
    return best_turn(traces, crossings(chart, traces.chords), QUARTER / 2)
