"""A case of which every quad mesh has an inverted quad."""

from typing import Any

OUTER = [(-1, -1), (1, -1), (1, 0), (0, 1), (-1, 1)]

INVERTED: dict[str, Any] = {
    "surface": {"builtin": "l_shape"},
    "singularities": [
        {"position": place, "valence": 5} for place in ([-0.5, 0.3, 0], [0.3, -0.5, 0])
    ],
    "corners": [{"position": [x, y, 0], "index": 1} for x, y in [*OUTER, (0, 0)]],
    "method": "anisotropic",
}
"""One quad alone at the inner corner of an L, of 270 degrees: no mesh has it upright."""
