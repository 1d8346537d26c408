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
from scipy.spatial import cKDTree

from crossview.cases.model import Case
from crossview.workflow.pipeline import Pipeline
from crossview.workflow.problem import Problem
from crossview.workflow.quads import MeshOptions, quads_of
from solvers.primitives import BUILTIN
from solvers.progress import run
from solvers.quads.corners import TangentPlanes, scaled_jacobian
from solvers.quads.projection import Projection
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
HEADER = """| surface | mesher | quads | others | irregular | boundary off | scaled Jacobian, min \
| mean | inverted | seconds |
|---|---|---:|---:|---:|---:|---:|---:|---:|---:|"""
CUBE = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]


@dataclass(frozen=True)
class Made:
    """What a mesher made of a surface: vertices (n, 3), quads (q, 4), triangles (t, 3)."""

    vertices: np.ndarray
    quads: np.ndarray
    triangles: np.ndarray
    seconds: float

    @property
    def edges(self) -> np.ndarray:
        """(e, 2) sides of all faces, twice if between two."""
        sides = [
            np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2)
            for faces in (self.quads, self.triangles)
        ]
        return np.sort(np.concatenate(sides), axis=1)

    @property
    def rim(self) -> np.ndarray:
        """(k, 2) edges with one face."""
        edges, count = np.unique(self.edges, axis=0, return_counts=True)
        return np.asarray(edges[count == 1])

    @property
    def irregular(self) -> int:
        """Inner vertices where not four edges meet."""
        degree = np.bincount(
            np.unique(self.edges, axis=0).reshape(-1), minlength=len(self.vertices)
        )
        inner = np.setdiff1d(np.arange(len(self.vertices)), self.rim)
        return int((degree[inner] != 4).sum())


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
    return Made(mesh.vertices, mesh.quads, np.empty((0, 3), dtype=int), seconds)


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
            return Made(
                found["vertices"], found["quads"], found["triangles"], float(found["seconds"])
            )


def row(surface: TriSurface, made: Made) -> list[str]:
    """The cells of the table about a mesh."""
    quality = scaled_jacobian(made.vertices[made.quads], _normals(surface, made))
    return [
        f"{len(made.quads)}",
        f"{len(made.triangles)}",
        f"{made.irregular}",
        _boundary(surface, made),
        f"{quality.min():.2f}",
        f"{quality.mean():.3f}",
        f"{int((quality <= 0).sum())}",
        f"{made.seconds:.2f}",
    ]


def _normals(surface: TriSurface, made: Made) -> np.ndarray:
    """The surface's normals (q, 4, 3) at the corners of quads."""
    faces, weights = Projection(surface).nearest(made.vertices)
    return TangentPlanes(surface).corner_normals(faces, weights, made.vertices, made.quads)


def _boundary(surface: TriSurface, made: Made) -> str:
    """How far the boundaries of surface and mesh are apart at most, in edges of a quad."""
    loops = surface.boundary_loops
    if not loops and not len(made.rim):
        return ""
    if not loops or not len(made.rim):
        return "lost" if loops else "torn open"
    sides = np.concatenate([np.stack([loop, np.roll(loop, -1)], axis=1) for loop in loops])
    there = _sampled(surface.vertices[sides])
    here = _sampled(made.vertices[made.rim])
    gap = max(cKDTree(a).query(b)[0].max() for a, b in ((there, here), (here, there)))
    return f"{gap / np.sqrt(surface.area / QUADS):.2f}"


def _sampled(segments: np.ndarray) -> np.ndarray:
    """Places (k, 3) along segments (s, 2, 3)."""
    t = np.linspace(0, 1, 21)[:, None, None]
    return (segments[:, 0] * (1 - t) + segments[:, 1] * t).reshape(-1, 3)


def rows(folder: Path | None) -> Iterator[str]:
    """The rows of the table as they are made."""
    for name, problem in problems(folder):
        surface = problem.surface
        label = f"{name}, {surface.n_faces} triangles"
        yield _line(label, "crossview", row(surface, ours(problem)))
        for peer in MODULES:
            made = theirs(peer, surface)
            cells = [made, *[""] * 7] if isinstance(made, str) else row(surface, made)
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
