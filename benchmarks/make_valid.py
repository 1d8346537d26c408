"""The study of docs/make_valid.md: 100 random configurations made valid.

    python -m benchmarks.make_valid docs/make_valid.md

writes the table, and each failure with its reason, between the lines that mark their place. Each
configuration has at least 2 + m singularities of mixed valences at random places, m the number of
conditions. Every success is checked by a fresh solve on the refined surface.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from solvers.errors import CrossviewError
from solvers.fields.isotropic import IsotropicSolver
from solvers.primitives import BUILTIN
from solvers.progress import run
from solvers.singularities.budget import Singularity, default_corners
from solvers.surface.points import SurfacePoint
from solvers.surface.refinement import refine_at
from solvers.surface.trisurface import TriSurface
from solvers.validity.attempts import make_valid

BEGIN, END = "<!-- table -->", "<!-- end of table -->"
HEADER = """| surfaces | conditions | singularities | made valid | to farther layouts | largest move, median | worst defect, fresh solve | seconds, median | only 2 + m unlocked |
|---|---:|---:|---:|---:|---:|---:|---:|---:|"""  # noqa: E501
GAP = 0.08
"""Least distance between singularities, in square roots of the area; to the boundary 0.7 of it."""

MOST_EXTRA = 12
"""How many valences 3 or 5 are at most added to meet the index budget."""


def plate(holes: int) -> Callable[[np.random.Generator], TriSurface]:
    return lambda _: BUILTIN["plate_with_holes"](holes=holes, edge_length=0.15)


FAMILIES: tuple[tuple[str, int, Callable[[np.random.Generator], TriSurface]], ...] = (
    ("annulus", 20, lambda rng: BUILTIN["annulus"](inner=float(rng.uniform(0.25, 0.7)), n=64)),
    *((f"plate, {h} hole{'s' * (h > 1)}", 8, plate(h)) for h in range(1, 6)),
    ("torus", 20, lambda rng: BUILTIN["torus"](minor=float(rng.uniform(0.3, 0.6)), n=48)),
    ("genus 2", 20, lambda _: BUILTIN["genus"](handles=2, subdivisions=2)),
)


@dataclass(frozen=True)
class Outcome:
    """What became of one configuration; `reason` is empty for a success."""

    conditions: int
    valences: tuple[int, ...]
    seconds: float
    reason: str
    move: float = 0.0
    defect: float = 0.0
    farther: bool = False


def outcomes(
    name: str, count: int, make: Callable[[np.random.Generator], TriSurface]
) -> Iterator[tuple[Outcome, Outcome]]:
    """Of each configuration, with all free and with only 2 + m of them."""
    for seed in range(count):
        rng = np.random.default_rng([sum(map(ord, name)), seed])
        surface = make(rng)
        conditions = 2 * surface.genus + max(len(surface.boundary_loops) - 1, 0)
        missing = 4 * surface.euler_characteristic - sum(default_corners(surface).values())
        valences = drawn_valences(missing, 2 + conditions, rng)
        places = drawn_places(surface, len(valences), rng)
        start = [Singularity(p, v) for p, v in zip(places, valences, strict=True)]
        held = [replace(s, locked=i >= 2 + conditions) for i, s in enumerate(start)]
        yield outcome(surface, conditions, start), outcome(surface, conditions, held)


def outcome(surface: TriSurface, conditions: int, start: list[Singularity]) -> Outcome:
    began = time.perf_counter()
    valences = tuple(sorted(s.valence for s in start))
    try:
        end = run(make_valid(surface, start))
    except CrossviewError as error:
        return Outcome(conditions, valences, time.perf_counter() - began, str(error))
    seconds = time.perf_counter() - began
    before = surface.positions([s.point for s in start])
    after = surface.positions([s.point for s in end.singularities])
    move = float(np.linalg.norm(after - before, axis=1).max()) / np.sqrt(surface.area)
    defect = fresh_defect(surface, end.singularities)
    reason = "" if defect < 1e-6 else f"a fresh solve finds {defect:.1e} degrees"
    return Outcome(conditions, valences, seconds, reason, move, defect, any(end.turns))


def fresh_defect(surface: TriSurface, singularities: tuple[Singularity, ...]) -> float:
    """The largest defect, degrees, of the field solved with the singularities as vertices."""
    refinement = refine_at(surface, [s.point for s in singularities])
    fine = refinement.surface
    placed = [
        Singularity(fine.point_at_vertex(int(v)), s.valence)
        for v, s in zip(refinement.vertices, singularities, strict=True)
    ]
    return float(np.degrees(np.abs(IsotropicSolver(fine).solve(placed).defects).max()))


def drawn_valences(missing: int, least: int, rng: np.random.Generator) -> list[int]:
    """At least so many, mostly 3 and 5, with indices that sum to what is missing."""
    while True:
        count = least + int(rng.integers(0, 4))
        drawn = rng.choice([3, 5, 2, 6, 7, 8], p=[0.4, 0.4, 0.06, 0.08, 0.03, 0.03], size=count)
        left = missing - int((4 - drawn).sum())
        if left == 0 or (abs(left) <= MOST_EXTRA and count > least):
            return [*drawn.tolist(), *[3 if left > 0 else 5] * abs(left)]


def drawn_places(surface: TriSurface, count: int, rng: np.random.Generator) -> list[SurfacePoint]:
    unit = np.sqrt(surface.area)
    rim = surface.vertices[surface.boundary_vertices]
    points: list[SurfacePoint] = []
    while len(points) < count:
        face = int(rng.choice(surface.n_faces, p=surface.face_areas / surface.area))
        first, second, third = rng.dirichlet([1, 1, 1]).tolist()
        point = SurfacePoint(face, (first, second, third))
        x = surface.position(point)
        to_rim = np.linalg.norm(rim - x, axis=1).min(initial=np.inf)
        to_others = np.linalg.norm(surface.positions(points) - x, axis=1).min(initial=np.inf)
        if to_rim > 0.7 * GAP * unit and to_others > GAP * unit:
            points.append(point)
    return points


def row(name: str, found: list[Outcome], held: list[Outcome]) -> str:
    good = [o for o in found if not o.reason]
    sizes = [len(o.valences) for o in found]
    cells = [
        name,
        str(found[0].conditions),
        f"{min(sizes)} to {max(sizes)}",
        f"{len(good)} of {len(found)}",
        str(sum(o.farther for o in good)),
        f"{np.median([o.move for o in good]):.2f}",
        f"{max(o.defect for o in good):.1e}°",
        f"{np.median([o.seconds for o in found]):.1f}",
        f"{sum(not o.reason for o in held)} of {len(held)}",
    ]
    return "| " + " | ".join(cells) + " |"


def main(page: Path) -> None:
    rows, failures, total = [HEADER], [], 0
    for name, count, make in FAMILIES:
        found, held = (list(column) for column in zip(*outcomes(name, count, make), strict=True))
        total += len(found)
        rows.append(row(name, found, held))
        print(rows[-1], flush=True)
        for what, tried in (("all free", found), ("2 + m free", held)):
            for seed, o in enumerate(tried):
                if o.reason:
                    valences = ", ".join(map(str, o.valences))
                    failures.append(
                        f"- {name}, seed {seed}, {what}, valences {valences}: {o.reason}"
                    )
                    print(failures[-1], flush=True)
    missed = sum(", all free," in failure for failure in failures)
    held_back = len(failures) - missed
    said = (
        f"{total - missed} of {total} made valid; with only 2 + m of their singularities unlocked, "
        f"{total - held_back} of {total}."
    )
    print(said)
    listed = ["Failures:", "", *failures] if failures else ["No failures."]
    before, _, rest = page.read_text(encoding="utf-8").partition(BEGIN)
    after = rest.partition(END)[2]
    table = "\n".join([BEGIN, "", *rows, "", said, "", *listed, "", END])
    page.write_text(before + table + after, encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
