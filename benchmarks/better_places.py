"""The study of docs/make_valid.md on better places: plates improved and snapped, scans simplified.

    CROSSVIEW_DATA=folder python -m benchmarks.better_places docs/make_valid.md

writes its two tables between the lines that mark their places. Without the environment variable,
which names the folder of the scans, that of the scans is left as it is.
"""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np

import crossview
from crossview import Case, Problem
from solvers.errors import CrossviewError
from solvers.fields import IsotropicSolver
from solvers.validity import Unevenness

PLATES = (1, 2, 3, 4, 5, 6)
"""Holes of the plates."""

SCANS = (
    "spot_low_resolution.obj",
    "hand_lowres.obj",
    "goathead.obj",
    "skull_low_resolution.obj",
    "demosthenes-low-res.obj",
)
"""Surfaces from files, closed or not."""

PLATE_HEADER = """| holes | triangles | variance of H | patches | T-junctions \
| least scaled Jacobian | seconds: improve, snap |
|---|---:|---:|---:|---:|---:|---:|"""
SCAN_HEADER = """| scan | triangles | singularities | variance of H | patches | T-junctions \
| least scaled Jacobian | quads inverted | seconds: simplify, improve |
|---|---:|---:|---:|---:|---:|---:|---:|---:|"""
ARROW = " \u2192 "
QUADS = 2000
"""How many are wanted."""


@dataclass(frozen=True)
class Measured:
    """What is told of one configuration, in words; what it has not is told by a dash."""

    singularities: str
    variance: str
    patches: str = "\u2013"
    t_junctions: str = "\u2013"
    jacobian: str = "\u2013"
    inverted: str = "\u2013"


def measured(problem: Problem, failures: list[str], name: str) -> Measured:
    """Lay a configuration out and fill it with quads."""
    sizes = Unevenness(IsotropicSolver(problem.surface)).sizes(problem.singularities)
    told = Measured(str(len(problem.singularities)), f"{sizes.variance:.3f}")
    try:
        layout = crossview.layout(crossview.solve(problem))
        told = replace(told, patches=str(layout.patches), t_junctions=str(len(layout.t_junctions)))
        quads = crossview.quads(layout, QUADS).scaled_jacobian
    except CrossviewError as error:
        failures.append(f"- {name}, {told.singularities} singularities: {error}")
        return told
    inverted = str(np.count_nonzero(quads <= 0))
    return replace(told, jacobian=f"{quads.min():.2f}", inverted=inverted)


def timed(
    step: Callable[[Problem], Problem], problem: Problem, failures: list[str], name: str
) -> tuple[Problem, str]:
    """Take a step to better places; where it is refused the configuration stays."""
    began = time.perf_counter()
    try:
        made = step(problem)
    except CrossviewError as error:
        failures.append(f"- {name}: {error}")
        return problem, "refused"
    return made, f"{time.perf_counter() - began:.1f}"


def row(name: str, problem: Problem, states: list[Measured], names: list[str], seconds: str) -> str:
    changes = [ARROW.join(getattr(state, key) for state in states) for key in names]
    cells = [name, f"{problem.surface.n_faces:,}".replace(",", " "), *changes, seconds]
    return "| " + " | ".join(cells) + " |"


def plates() -> list[str]:
    """Each placed as `complete` and `make-valid` do, then improved, then snapped."""
    rows, failures = [PLATE_HEADER], list[str]()
    for holes in PLATES:
        name = f"plate, {holes} hole{'s' * (holes > 1)}"
        surface = crossview.primitives.plate_with_holes(holes=holes)
        placed = crossview.make_valid(crossview.complete(Problem(surface)))
        improved, first = timed(crossview.improve, placed, failures, f"{name}, improve")
        snapped, second = timed(crossview.snap, improved, failures, f"{name}, snap")
        states = [measured(p, failures, name) for p in (placed, improved, snapped)]
        names = ["variance", "patches", "t_junctions", "jacobian"]
        rows.append(row(str(holes), placed, states, names, f"{first}, {second}"))
        print(rows[-1], flush=True)
    return [*rows, *listed(failures)]


def scans(folder: Path) -> list[str]:
    """Natural singularities of each, half of them, and those improved."""
    rows, failures = [SCAN_HEADER], list[str]()
    for file in SCANS:
        name = Path(file).stem
        bare = Problem.from_case(Case(str(folder / file)))
        natural = crossview.make_valid(crossview.natural(bare))
        half = len(natural.singularities) // 2
        fewer, seconds = timed(
            partial(crossview.simplify, most=half), natural, failures, f"{name}, simplify"
        )
        better, more = timed(crossview.improve, fewer, failures, f"{name}, improve")
        states = [measured(p, failures, name) for p in (natural, fewer, better)]
        names = ["singularities", "variance", "patches", "t_junctions", "jacobian", "inverted"]
        rows.append(row(name, natural, states, names, f"{seconds}, {more}"))
        print(rows[-1], flush=True)
    return [*rows, *listed(failures)]


def listed(failures: list[str]) -> list[str]:
    for failure in failures:
        print(failure, flush=True)
    return ["", "Failures:", "", *failures] if failures else []


def put(page: Path, mark: str, lines: list[str]) -> None:
    """Write lines between those that mark their place in a page."""
    begin, end = f"<!-- {mark} -->", f"<!-- end of {mark} -->"
    before, _, rest = page.read_text(encoding="utf-8").partition(begin)
    after = rest.partition(end)[2]
    table = "\n".join([begin, "", *lines, "", end])
    page.write_text(before + table + after, encoding="utf-8")


def main(page: Path) -> None:
    put(page, "plates", plates())
    data = os.environ.get("CROSSVIEW_DATA")
    if data is not None:
        put(page, "scans", scans(Path(data)))


if __name__ == "__main__":
    main(Path(sys.argv[1]))
