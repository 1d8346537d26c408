"""crossview info: what a surface is, what is wrong with it, what its singularities must sum to."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from crossview.cli.describe import describe
from crossview.cli.options import Json, SurfaceOptions
from crossview.cli.terminal import say, say_json

STATUS = {"yes": 0, "with repair": 1, "no": 2}
"""Exit status for each answer to whether a surface is usable."""


def info(
    surface: str,
    /,
    *,
    chosen: SurfaceOptions = SurfaceOptions(),
    as_json: Json = False,
) -> int:
    """Describe a surface: counts, topology, problems, what its singularities must sum to.

    The exit status is 0 if each component can be solved on, 1 if it can with --repair, 2 if not.

    Parameters
    ----------
    surface
        A surface file, a case, or the name of a built-in surface.
    as_json
        Print JSON, with the numbers of all offending elements.
    """
    found = describe(chosen.case(surface))
    if as_json:
        say_json(found)
    else:
        for line in _lines(surface, found):
            say(line)
    return STATUS[found["usable"]]


def _lines(name: str, found: dict[str, Any]) -> Iterator[str]:
    yield f"{name}: {found['vertices']} vertices, {found['faces']} triangles"
    for note in found["notes"]:
        yield f"  note: {note}"
    for problem in found["problems"]:
        yield f"  problem: {problem['message']}"
    pieces = found["components"]
    for number, piece in enumerate(pieces):
        indent = "  "
        if len(pieces) > 1:
            counts = f"{piece['vertices']} vertices, {piece['faces']} triangles"
            yield f"  component {number}: {counts}"
            indent = "    "
        yield (
            f"{indent}Euler characteristic {piece['euler_characteristic']}, "
            f"genus {piece['genus']}, {_boundary(piece['boundary_lengths'])}"
        )
        quality = piece["triangle_quality"]
        yield (
            f"{indent}area {piece['area']:.6g}, diagonal {piece['diagonal']:.6g}, "
            f"triangle quality {quality['min']:.2f} to {quality['max']:.2f}, "
            f"mean {quality['mean']:.2f}"
        )
        budget, known = piece["index_budget"], piece["existence"]
        yield f"{indent}{budget['message']}, corners {_corners(piece['corners'])}"
        if budget["satisfied"] and known["theorem"] is not None:
            mended = " or ".join(known["remedies"])
            yield f"{indent}impossible: {known['theorem']} To mend it, {mended}."


def _boundary(lengths: list[float]) -> str:
    if not lengths:
        return "closed"
    loops = "1 boundary loop" if len(lengths) == 1 else f"{len(lengths)} boundary loops"
    return f"{loops} of length {', '.join(f'{length:.6g}' for length in lengths)}"


def _corners(corners: list[dict[str, Any]]) -> str:
    indices = [corner["index"] for corner in corners]
    return ", ".join(f"{indices.count(k)} of {k:+d}" for k in sorted(set(indices))) or "none"
