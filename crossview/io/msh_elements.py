"""The elements of Gmsh: how many nodes each type has, and which are parts of surfaces."""

from __future__ import annotations


def _table(text: str) -> dict[int, int]:
    """The number of nodes of types written as "type:nodes"."""
    pairs = (pair.split(":") for pair in text.split())
    return {int(kind): int(nodes) for kind, nodes in pairs}


TRIANGLES = _table(
    "2:3 9:6 20:9 21:10 22:12 23:15 24:15 25:21 42:28 43:36 44:45 45:55 46:66 52:18 53:21 54:24 "
    "55:27 56:30"
)
"""Nodes of each type of triangle, corners first. From gmsh's documentation, as all of these."""

QUADS = _table(
    "3:4 10:9 16:8 36:16 37:25 38:36 39:12 40:16 41:20 47:49 48:64 49:81 50:100 51:121 57:24 58:28 "
    "59:32 60:36 61:40"
)
"""Of each type of quad."""

LINES = _table("15:1 1:2 8:3 26:4 27:5 28:6 62:7 63:8 64:9 65:10 66:11 84:1")
"""Of points and lines."""

VOLUMES = _table(
    "4:4 5:8 6:6 7:5 11:10 12:27 13:18 14:14 17:20 18:15 19:13 29:20 30:35 31:56 32:22 33:28 71:84 "
    "72:120 73:165 74:220 75:286 90:40 91:75 92:64 93:125 94:216 95:343 96:512 97:729 98:1000"
)
"""Of solids."""

NODES = {**TRIANGLES, **QUADS, **LINES, **VOLUMES}
"""Of all types."""

CORNERS = {**dict.fromkeys(TRIANGLES, 3), **dict.fromkeys(QUADS, 4)}
"""Corners of those on surfaces; their further nodes lie on edges and inside."""
