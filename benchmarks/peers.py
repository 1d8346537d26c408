"""Quads beside those of Instant Meshes, QuadriFlow and gmsh, on the same surfaces in one run.

    python -m benchmarks.peers docs/quads.md

prints the table and writes it between the lines that mark its place; without a page it is only
printed. CROSSVIEW_DATA names the folder of the surfaces from files; without it they are left out.
A peer that is not installed, crashes or takes longer than `PATIENCE` is told so in its row.
"""

from __future__ import annotations

import importlib.util
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from crossview.cases.model import Case
from crossview.certificate import Faces, Reference, certify
from crossview.workflow.certification import faces_of, reference
from crossview.workflow.pipeline import Pipeline
from crossview.workflow.problem import Problem
from crossview.workflow.quads import MeshOptions, quads_of
from solvers.primitives import BUILTIN
from solvers.progress import run
from solvers.singularities.budget import Singularity
from solvers.singularities.farthest import far_points
from solvers.surface.trisurface import TriSurface

BEGIN, END = "<!-- peers -->", "<!-- end of peers -->"
QUADS = 5_000
PATIENCE = 120.0
"""Seconds a peer may take for one surface."""

MODULES = {
    "Instant Meshes": "pyinstantmeshes",
    "QuadriFlow": "pyQuadriFlow",
    "gmsh quasi-structured": "gmsh",
}
HEADER = """| surface | mesher | quads | others | irregular | surface off | boundary off | area \
| scaled Jacobian, min | mean | inverted | seconds |
|---|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|"""
CELLS = HEADER.partition("\n")[0].count("|") - 3
"""Cells of a row beside surface and mesher."""

CUBE = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]


@dataclass(frozen=True)
class Made:
    """What a mesher made of a surface, and in how long."""

    faces: Faces
    seconds: float


def problems(folder: Path | None) -> Iterator[tuple[str, Problem]]:
    """Surfaces with what is imposed on them, and their names."""
    ball = BUILTIN["sphere"](subdivisions=5)
    cube = tuple(Singularity(ball.closest_point(np.array(p) / 3**0.5), 3) for p in CUBE)
    yield "sphere", Problem(ball, cube)
    yield "torus", Problem(BUILTIN["torus"](n=160))
    yield "annulus", Problem(BUILTIN["annulus"](n=240))
    if folder is None:
        return
    for file in ("spot_low_resolution.obj", "goathead.obj"):
        surface = Problem.from_case(Case(str(folder / file))).surface
        eight = tuple(Singularity(p, 3) for p in run(far_points(surface, (), 8)))
        yield file, Problem(surface, eight)


def ours(problem: Problem) -> Made:
    """From the surface with its singularities to quads, nothing kept from before."""
    surface = TriSurface(problem.surface.vertices, problem.surface.faces)
    fresh = replace(problem, surface=surface)
    start = time.perf_counter()
    solution = run(Pipeline().solve(fresh))
    _, _, mesh = run(quads_of(solution, MeshOptions(target_quads=QUADS)))
    seconds = time.perf_counter() - start
    return Made(faces_of(mesh), seconds)


def theirs(peer: str, surface: TriSurface) -> Made | str:
    """What a peer makes of a surface, or in a few words why nothing."""
    if importlib.util.find_spec(MODULES[peer]) is None:
        return "not installed"
    with tempfile.TemporaryDirectory() as folder:
        given, made = Path(folder, "in.npz"), Path(folder, "out.npz")
        np.savez(given, vertices=surface.vertices, faces=surface.faces, wanted=QUADS)
        command = [sys.executable, "-m", "benchmarks.remesh", peer, str(given), str(made)]
        try:
            ran = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE)
        except subprocess.TimeoutExpired:
            return f"nothing in {PATIENCE:.0f} s"
        if ran.returncode != 0:
            said = ran.stderr.strip().splitlines()
            return f"failed: {said[-1]}" if said else f"crashed ({ran.returncode})"
        with np.load(made) as found:
            blocks = [found["quads"], found["triangles"]]
            sizes = np.concatenate([np.full(len(b), b.shape[1], dtype=np.int64) for b in blocks])
            corners = np.concatenate([b.reshape(-1).astype(np.int64) for b in blocks])
            return Made(Faces(found["vertices"], sizes, corners), float(found["seconds"]))


def row(against: Reference, made: Made) -> list[str]:
    """The cells of the table about a mesh, as the certificate measures it."""
    found = certify(made.faces, against).measures
    counts, corners, edge = found["counts"], found["corners"], found["mean_edge"]
    distances = found["distances"]
    return [
        f"{counts['quads']}",
        f"{counts['non_quads']}",
        f"{sum(found['irregular']['found'].values())}",
        _gap(distances, "faces_to_surface", "surface_to_faces", edge),
        _gap(distances, "boundary_to_surface", "surface_to_boundary", edge),
        f"{distances['area_ratio']:.4f}",
        f"{corners['min_scaled_jacobian']:.2f}",
        f"{corners['mean_scaled_jacobian']:.3f}",
        _inverted(corners),
        f"{made.seconds:.2f}",
    ]


def _inverted(corners: dict[str, int]) -> str:
    """How many faces are inverted, and at how many vertices of valence 2 that is excused."""
    excused = corners["excused_at_valence_2"]
    return f"{corners['inverted_faces']}" + (f", {excused} at valence 2" if excused else "")


def _gap(distances: dict[str, float | None], one: str, other: str, edge: float) -> str:
    """The larger of two distances in edges; empty where there is nothing to measure."""
    if one not in distances:
        return ""
    here, there = distances[one], distances[other]
    return "lost" if here is None or there is None else f"{max(here, there) / edge:.2f}"


def rows(folder: Path | None) -> Iterator[str]:
    """The rows of the table as they are made."""
    for name, problem in problems(folder):
        surface, against = problem.surface, reference([problem], False)
        label = f"{name}, {surface.n_faces} triangles"
        yield _line(label, "crossview", row(against, ours(problem)))
        for peer in MODULES:
            made = theirs(peer, surface)
            cells = [made, *[""] * (CELLS - 1)] if isinstance(made, str) else row(against, made)
            yield _line(label, peer, cells)


def _line(*cells: str | list[str]) -> str:
    flat = [c for cell in cells for c in ([cell] if isinstance(cell, str) else cell)]
    return "| " + " | ".join(flat) + " |"


def main(page: Path | None, folder: Path | None) -> None:
    table = [HEADER]
    print(HEADER, flush=True)
    for line in rows(folder):
        table.append(line)
        print(line, flush=True)
    if page is not None:
        before, _, rest = page.read_text(encoding="utf-8").partition(BEGIN)
        after = rest.partition(END)[2]
        written = "\n".join([BEGIN, "", *table, "", END])
        page.write_text(before + written + after, encoding="utf-8")


if __name__ == "__main__":
    data = os.environ.get("CROSSVIEW_DATA")
    main(Path(sys.argv[1]) if sys.argv[1:] else None, Path(data) if data else None)
