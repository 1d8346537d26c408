"""A file that only a cut can make a surface of."""

from pathlib import Path

CELLS = ((1, 0), (2, 0), (2, 1), (2, 2), (1, 2), (0, 2), (0, 1))
"""Unit squares in a row whose ends touch in one vertex."""


def pinched(path: Path, *pieces: str) -> str:
    """Write the triangles of `CELLS` to an OBJ file, after lines of other pieces."""
    lines = list(pieces)
    for x, y in CELLS:
        lines += [f"v {x + i} {y + j} 0" for i, j in ((0, 0), (1, 0), (1, 1), (0, 1))]
        lines += ["f -4 -3 -2", "f -4 -2 -1"]
    path.write_text("\n".join(_shared(lines)) + "\n")
    return str(path)


def _shared(lines: list[str]) -> list[str]:
    """Return lines of an OBJ file with one vertex a place."""
    places: list[str] = []
    written: list[str] = []
    faces: list[str] = []
    for line in lines:
        kind, *rest = line.split()
        if kind == "v":
            written.append(line)
            places += [] if line in places else [line]
        else:
            numbers = [places.index(written[len(written) + int(k)]) + 1 for k in rest]
            faces.append("f " + " ".join(map(str, numbers)))
    return places + faces
