"""The table of docs/anisotropic.md: minimum-norm Newton beside the paper's alternation.

    python -m benchmarks.table docs/anisotropic.md

writes it between the lines that mark its place. The environment variable CROSSVIEW_DATA names the
folder of the surfaces from files; without it they are left out.
"""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from crossview.cases.model import Case
from crossview.workflow.problem import Problem
from solvers.fields.aligned import AlignedField, aligned_field
from solvers.fields.alternating import alternate
from solvers.fields.anisotropic import Descent, MinimumNormNewton
from solvers.fields.prepared import prepare
from solvers.primitives import BUILTIN
from solvers.progress import run
from solvers.singularities.budget import Singularity, default_corners
from solvers.singularities.farthest import far_points
from solvers.surface.trisurface import TriSurface
from tests.solvers.suite import separated

BEGIN, END = "<!-- table -->", "<!-- end of table -->"
HEADER = """| case | triangles | worst defect | E at H1 = H2 = 0 | steps | E | seconds \
| E aligned | alternating, weight 1 | iterations, seconds | weight 1e-3 | iterations, seconds |
|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|"""
REAL = (
    ("sphere.obj", 8, 3),
    ("spot_low_resolution.obj", 8, 3),
    ("goathead.obj", 8, 3),
    ("wingnut.obj", 8, 3),
    ("torus.obj", 4, 0),
    ("skull_low_resolution.obj", 8, 5),
)


@dataclass(frozen=True)
class Entry:
    """A configuration with a name."""

    name: str
    surface: TriSurface
    singularities: list[Singularity]


def entries(folder: Path | None) -> Iterator[Entry]:
    for seed in range(20):
        annulus = BUILTIN["annulus"](inner=0.4, n=64)
        yield Entry(f"annulus, seed {seed}", annulus, separated(annulus, seed, [3, 5] * 4, 0.2))
    yield made("plate with 2 holes", BUILTIN["plate_with_holes"](edge_length=0.15), [5] * 4, 0.4)
    three = BUILTIN["plate_with_holes"](holes=3, edge_length=0.15)
    yield made("plate with 3 holes, valence 6", three, [5] * 6 + [6], 0.4)
    yield made("annulus, valence 6", BUILTIN["annulus"](n=64), [6, 3, 3], 0.3)
    yield made("annulus, valence 8", BUILTIN["annulus"](n=64), [8, 3, 3, 3, 3], 0.25)
    yield made("torus, 3 3 5 5", BUILTIN["torus"](n=48), [3, 3, 5, 5], 0.4)
    yield made("sphere", BUILTIN["sphere"](subdivisions=4), [3] * 8, 0.4)
    if folder is None:
        return
    for file, number, valence in REAL:
        surface = Problem.from_case(Case(str(folder / file))).surface
        places = run(far_points(surface, (), number))
        valences = [valence] * number if valence else [3, 5] * (number // 2)
        singularities = [Singularity(p, v) for p, v in zip(places, valences, strict=True)]
        yield Entry(file, surface, singularities)


def made(name: str, surface: TriSurface, valences: list[int], gap: float) -> Entry:
    """An entry whose index budget is met by as many valences 3 or 5 as are missing."""
    corners = sum(default_corners(surface).values())
    missing = 4 * surface.euler_characteristic - corners - sum(4 - v for v in valences)
    valences = valences + [3 if missing > 0 else 5] * abs(missing)
    return Entry(name, surface, separated(surface, 0, valences, gap))


def row(entry: Entry) -> str:
    aligned = aligned_field(prepare(entry.surface, entry.singularities, refine=0))
    worst = np.degrees(np.abs(aligned.isotropic.defects).max(initial=0.0))
    newton, seconds = timed(lambda: newton_from_zero(aligned))
    cells = [
        entry.name,
        f"{entry.surface.n_faces}",
        f"{worst:.1f}°",
        f"{newton.history[0]:.3g}",
        f"{len(newton.history) - 1}",
        f"{newton.history[-1]:.1e}",
        f"{seconds:.2f}",
        f"{aligned.integrability.residual(aligned.start).energy:.3g}",
    ]
    for weight in (1.0, 1e-3):
        end, seconds = timed(partial(run, alternate(aligned, weight)))
        cells += [f"{end.history[-1]:.1e}", f"{len(end.history) - 1}, {seconds:.1f}"]
    return "| " + " | ".join(cells) + " |"


def newton_from_zero(aligned: AlignedField) -> Descent:
    newton = MinimumNormNewton(aligned.integrability)
    return run(newton.solve(np.zeros(aligned.integrability.assembly.n)))


def timed(work: Callable[[], Descent]) -> tuple[Descent, float]:
    start = time.perf_counter()
    end = work()
    return end, time.perf_counter() - start


def main(page: Path, folder: Path | None) -> None:
    rows = [HEADER]
    for entry in entries(folder):
        rows.append(row(entry))
        print(rows[-1], flush=True)
    before, _, rest = page.read_text(encoding="utf-8").partition(BEGIN)
    after = rest.partition(END)[2]
    table = "\n".join([BEGIN, "", *rows, "", END])
    page.write_text(before + table + after, encoding="utf-8")


if __name__ == "__main__":
    data = os.environ.get("CROSSVIEW_DATA")
    main(Path(sys.argv[1]), Path(data) if data else None)
