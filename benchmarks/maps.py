"""The study of docs/maps.md: how many surfaces and configurations get their map, and what stops it.

    CROSSVIEW_DATA=folder python -m benchmarks.maps docs/maps.md rows.jsonl [minutes]

tries each surface of the folder and each of `poor_surfaces` plainly and with sharp edges followed,
random valid configurations, and one singularity of each valence. Each runs in a process of its own
with limits of time and memory; what became of it is added to the rows, and what is there already is
not run again. After so many minutes, if any are given, no other row is begun. The tables are
written between the lines of the page that mark their place.
"""

from __future__ import annotations

import json
import os
import resource
import signal
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from hashlib import sha256
from pathlib import Path
from typing import Any
from unittest.mock import patch

import numpy as np
from scipy.sparse import csc_array

from benchmarks import map_configurations
from benchmarks.map_check import Connectivity, Findings, check, sums_in_sectors
from benchmarks.poor_surfaces import POOR
from crossview import Problem, Solution, natural, read
from crossview.workflow.marking import Marking
from crossview.workflow.pipeline import Pipeline
from solvers.algebra.factorization import Factorization
from solvers.errors import CrossviewError
from solvers.fields.aligned import IntegratedField
from solvers.maps import SeamlessMap, seamless, seamless_map
from solvers.progress import run

Row = dict[str, Any]

BEGIN, END = "<!-- table -->", "<!-- end of table -->"
PATIENCE = 60
"""Seconds of computing that one row may take, whatever else the machine does."""

MEMORY = 64 * 2**30
"""Bytes of addresses that one row may take: factorisations reserve many times what they use."""

LARGEST = 40_000
"""Triangles of a surface beyond which it is left out."""

SHARP = 40.0
"""Degrees beyond which an edge is a feature, where features are followed."""

WAYS = {"plain": Marking(), "features": Marking(dihedral_degrees=SHARP)}


def linear(integrated: IntegratedField) -> SeamlessMap:
    """The map nearest to the field, as one solve gives it, inverted triangles left as they are."""
    none = patch.object(seamless, "flat_metric", return_value=None)
    with none, patch.object(seamless, "ROUNDS", 0):
        return seamless_map(integrated)


STEPS = ("linear", "used")
"""The maps that are checked: nearest to the field, as one solve gives it, and the one used."""


def study(folder: Path | None) -> Iterator[tuple[str, str]]:
    """Names of all rows and ways: surfaces, then configurations.

    Files come in an order that has nothing to do with size: what time leaves out is left by chance.
    """
    files = [p for p in folder.iterdir() if p.suffix != ".tsv"] if folder else []
    shuffled = sorted(files, key=lambda p: sha256(p.name.encode()).digest())
    for name in (*POOR, *map(str, shuffled)):
        for way in WAYS:
            yield name, way
    for d in map_configurations.drawn():
        yield f"{d.family}, seed {d.seed}", "anisotropic"
    for v in map_configurations.of_valences():
        yield f"{v.mesh} sphere, valence {v.valence}", "anisotropic"


def problem_named(name: str, say: Callable[..., None]) -> Problem:
    """The problem of a row; natural singularities or valid places are found here."""
    for d in map_configurations.drawn():
        if name == f"{d.family}, seed {d.seed}":
            say(stage="make valid")
            return d.problem()
    for v in map_configurations.of_valences():
        if name == f"{v.mesh} sphere, valence {v.valence}":
            return v.problem()
    return Problem(POOR[name]()) if name in POOR else read(name, component="largest")


def one(name: str, way: str) -> None:
    """Print what becomes of one row, a JSON object a line as soon as it is known."""

    def say(**known: object) -> None:
        print(json.dumps(known), flush=True)

    say(stage="read")
    try:
        with counted() as factors:
            _one(name, way, say, factors)
    except CrossviewError as error:
        say(refused=str(error))
    except MemoryError:
        say(refused="out of memory")
    except Exception as error:
        say(crashed=f"{type(error).__name__}: {error}")
    say(total=round(time.process_time(), 2))


def _one(name: str, way: str, say: Callable[..., None], factors: list[int]) -> None:
    problem = problem_named(name, say)
    surface = problem.surface
    say(triangles=surface.n_faces, chi=surface.euler_characteristic)
    say(boundaries=len(surface.boundary_loops))
    if surface.n_faces > LARGEST:
        raise CrossviewError("more triangles than are tried")
    method = "anisotropic"
    if way in WAYS:
        say(stage="natural")
        problem = natural(replace(problem, marking=WAYS[way]))
    else:
        method = way
    say(singularities=len(problem.singularities))
    say(valences=sorted(Counter(s.valence for s in problem.singularities).items()))
    say(edges=len(problem.features.edges), stage="solve")
    start, before = time.process_time(), len(factors)
    solution = run(Pipeline().solve(replace(problem, method=method)))
    say(solve_seconds=round(time.process_time() - start, 2), factors=len(factors) - before)
    say(verdict=solution.verdict.status, reason=solution.verdict.reason)
    say(unusable=solution.verdict.refused, energy=solution.field.energy, stage="map")
    say(solved_triangles=solution.surface.n_faces, released=len(solution.released.curves))
    _maps(solution, say)
    say(stage="done")


def _maps(solution: Solution, say: Callable[..., None]) -> None:
    """Tell what is wrong with the maps of a solution."""
    integrated = solution.integrated
    assert integrated is not None
    used = seamless_map(integrated) if solution.mapped is None else solution.mapped.map
    for step, map_ in zip(STEPS, (linear(integrated), used), strict=True):
        connectivity = connectivity_of(map_)
        found = check(connectivity, map_.images, wanted_quads(solution, map_))
        say(**{step: vars(found)})
        if step == "linear":  # its triangles are those of the field
            angles = sums_in_sectors(connectivity, _prescribed(integrated))
            say(sectors_empty=int((angles < 0.5).sum()))


def connectivity_of(map_: SeamlessMap) -> Connectivity:
    """What the check needs of the triangles that a map lives on."""
    t = map_.matching.triangulation
    return Connectivity(t.faces.reshape(-1), t.twin, map_.matching.aligned | (t.twin < 0))


def wanted_quads(solution: Solution, map_: SeamlessMap) -> np.ndarray:
    """How many quads are to meet at each vertex of the triangles that a map lives on.

    Not read from the map's matching: vertices that the surface does not have are regular.
    """
    surface, t = solution.surface, map_.matching.triangulation
    border = np.flatnonzero(t.twin < 0)
    quads = np.full(t.n_vertices, 4)
    quads[t.tail[border]] = 2
    for vertex, index in solution.prepared.corners.items():
        quads[vertex] -= index
    for s in solution.singularities:
        face, weights = s.point.face, s.point.barycentric
        quads[surface.faces[face][int(np.argmax(weights))]] -= s.index
    return quads


def _prescribed(integrated: IntegratedField) -> np.ndarray:
    """The angle that the field gives to each corner (3 m,), quarter turns."""
    i = integrated.aligned.integrability
    t = i.triangulation
    turned = i.offsets + i.local(integrated.x)[2]
    back = np.roll(turned, 1, axis=1)
    return np.asarray((t.angles.reshape(-1, 3) - back + turned).reshape(-1) / (np.pi / 2))


@contextmanager
def counted() -> Iterator[list[int]]:
    """The sizes of the matrices that are factorised meanwhile."""
    sizes: list[int] = []
    make = Factorization.__init__

    def noted(self: Factorization, matrix: csc_array, *args: Any, **kwargs: Any) -> None:
        sizes.append(matrix.shape[0])
        make(self, matrix, *args, **kwargs)

    with patch.object(Factorization, "__init__", noted):
        yield sizes


def tried(name: str, way: str) -> Row:
    """Run one row in a process of its own."""
    command = [sys.executable, "-m", "benchmarks.maps", "--one", name, way]
    row: Row = {"name": Path(name).name, "way": way}
    ran = subprocess.run(command, capture_output=True, text=True, preexec_fn=_limit)
    for line in ran.stdout.splitlines():
        row |= json.loads(line)
    if ran.returncode == -signal.SIGXCPU:
        row["late"] = True
    elif ran.returncode != 0:
        row["crashed"] = f"exit status {ran.returncode}"
    return row


def _limit() -> None:
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    resource.setrlimit(resource.RLIMIT_CPU, (PATIENCE, PATIENCE + 1))


def cause(row: Row) -> str:
    """Why a row has no map that is right, in a few words; empty if it has one."""
    stage, last = row.get("stage", "read"), row.get(STEPS[-1])
    if row.get("late"):
        return f"time ({stage})"
    if "crashed" in row:
        return f"crash ({stage})"
    if "refused" in row:
        if "valence" in row["refused"]:
            return "valence refused"
        return f"refused ({stage})"
    if row["unusable"]:
        if row["verdict"] == "impossible":
            return "impossible"
        return "misaligned" if " off a " in row["reason"] else "not integrable"
    assert last is not None
    wrong = {fault for fault in vars(Findings(0, 0, 0, 0, 0, 0)) if last[fault]}
    if not wrong:
        return ""
    if row["sectors_empty"]:
        return "empty sectors"
    if "inverted" in wrong:
        return "inverted, wrong windings" if "windings" in wrong else "inverted"
    return "wrong windings" if "windings" in wrong else "not seamless"


def kind(row: Row) -> str:
    """Which table a row is in."""
    if row["way"] in WAYS:
        return "surfaces"
    return "valences" if ", valence " in row["name"] else "configurations"


def rates(rows: list[Row], named: Callable[[Row], str]) -> list[str]:
    """Success of each group of rows, and how many fail of what."""
    lines = ["| | right | fail | of what |", "|---|---:|---:|---|"]
    groups: dict[str, list[str]] = {}
    for row in rows:
        groups.setdefault(named(row), []).append(cause(row))
    for name, causes in groups.items():
        why = Counter(c for c in causes if c)
        good, failed = causes.count(""), sum(why.values())
        listed = ", ".join(f"{n} {what}" for what, n in why.most_common())
        lines.append(f"| {name} | {good} of {len(causes)} | {failed} | {listed} |")
    return lines


def table(rows: list[Row]) -> list[str]:
    """All rows, those that fail first."""
    head = ["surface", "triangles", "way", "singularities", "released", "verdict"]
    head += ["empty sectors", *(f"{s}: inverted, windings" for s in STEPS), "seconds"]
    head += ["factorisations", "why not"]
    lines = [
        "| " + " | ".join(head) + " |",
        "|---|---:|---|---:|---:|---|" + "---:|" * (3 + len(STEPS)) + "---|",
    ]
    for row in sorted(rows, key=lambda r: (not cause(r), r["name"], r["way"])):
        steps = [row.get(s) for s in STEPS]
        said = row.get("refused") or row.get("crashed") or row.get("reason", "")
        why = f"{cause(row)}: {said}" if cause(row) else ""
        cells: list[object] = [row["name"], row.get("triangles", ""), row["way"]]
        cells += [row.get(k, "") for k in ("singularities", "released", "verdict", "sectors_empty")]
        cells += [f"{s['inverted']}, {s['windings']}" if s else "" for s in steps]
        cells += [row.get("total", ""), row.get("factors", "")]
        cells.append(why.replace("|", "/").replace("\n", " "))
        lines.append("| " + " | ".join(map(str, cells)) + " |")
    return lines


def page_of(rows: list[Row], every: list[tuple[str, str]]) -> str:
    """The tables of the rows that were run, of all."""
    by_kind = {
        k: [r for r in rows if kind(r) == k] for k in ("surfaces", "configurations", "valences")
    }
    surfaces, drawn, valences = by_kind.values()
    of = Counter(kind({"name": name, "way": way}) for name, way in every)
    run_of = {k: f"{len(of_kind)} of {of[k]} rows run:" for k, of_kind in by_kind.items()}
    parts = ["## Surfaces", "", run_of["surfaces"], "", *rates(surfaces, lambda r: r["way"])]
    parts += ["", *table(surfaces), ""]
    of_family = rates(drawn, lambda r: f"{r['name'].partition(',')[0]}, {r['way']}")
    failing = [r for r in drawn if cause(r)]
    parts += ["## Random valid configurations", "", run_of["configurations"], ""]
    parts += [*rates(drawn, lambda r: r["way"]), "", *of_family, ""]
    parts += [*table(failing), ""] if failing else []
    of_mesh = rates(valences, lambda r: r["name"].partition(",")[0])
    parts += ["## One singularity of valence 1 to 24", "", run_of["valences"], ""]
    parts += [*of_mesh, "", *table(valences)]
    return "\n".join(parts)


def main(page: Path, kept: Path, folder: Path | None, minutes: float) -> None:
    end, every = time.monotonic() + 60 * minutes, list(study(folder))
    rows = [json.loads(line) for line in kept.read_text().splitlines()] if kept.exists() else []
    known = {(r["name"], r["way"]) for r in rows}
    for name, way in every:
        if time.monotonic() >= end:
            break
        if (Path(name).name, way) in known:
            continue
        rows.append(tried(name, way))
        with kept.open("a") as file:
            file.write(json.dumps(rows[-1]) + "\n")
        print(
            Path(name).name, way, cause(rows[-1]) or "right", rows[-1].get("total", ""), flush=True
        )
    before, _, rest = page.read_text(encoding="utf-8").partition(BEGIN)
    after = rest.partition(END)[2]
    text = before + "\n".join([BEGIN, "", page_of(rows, every), "", END]) + after
    page.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    if sys.argv[1] == "--one":
        one(*sys.argv[2:])
    else:
        data = os.environ.get("CROSSVIEW_DATA")
        minutes = float(sys.argv[3]) if len(sys.argv) > 3 else float("inf")
        main(Path(sys.argv[1]), Path(sys.argv[2]), Path(data) if data else None, minutes)
