"""The study of docs/natural.md: which eight singularities appear on the sphere.

    python -m benchmarks.anticube docs/natural.md

writes the table between the lines that mark its place. A start counts as the anticube, or the cube,
if after the best rotation every singularity is within 2 degrees of one of its corners.
"""

from __future__ import annotations

import sys
import time
from itertools import permutations
from pathlib import Path

import numpy as np
from scipy.optimize import linear_sum_assignment, minimize

from solvers.fields.natural import natural_singularities
from solvers.primitives import BUILTIN
from solvers.progress import run
from solvers.surface.triangulation import FloatArray

BEGIN, END = "<!-- table -->", "<!-- end of table -->"
HEADER = """| method | vertices | starts | eight valence 3 | anticube | cube | farthest from the anticube, median | worst | seconds, median |
|---|---:|---:|---:|---:|---:|---:|---:|---:|"""  # noqa: E501
STARTS, WITHIN = 20, 2.0
CASES = (("mbo", 5), ("mbo", 4), ("ginzburg-landau", 4))


def unit(points: FloatArray) -> FloatArray:
    """Move points (k, 3) to the unit sphere."""
    return np.asarray(points / np.linalg.norm(points, axis=1)[:, None])


def anticube() -> FloatArray:
    """Eight points that repel each other by the logarithm of their distance, at rest."""
    one, other = np.triu_indices(8, 1)

    def energy(x: FloatArray) -> float:
        p = unit(x.reshape(-1, 3))
        return float(-np.log(np.linalg.norm(p[one] - p[other], axis=1)).sum())

    starts = (np.random.default_rng(seed).normal(size=24) for seed in range(6))
    ends = [minimize(energy, start, tol=1e-14) for start in starts]
    return unit(min(ends, key=lambda end: end.fun).x.reshape(-1, 3))


def cube() -> FloatArray:
    """The corners of the cube."""
    return unit(np.stack(np.meshgrid(*[[-1.0, 1.0]] * 3), axis=-1).reshape(-1, 3))


def distance(points: FloatArray, model: FloatArray) -> float:
    """Degrees from points (8, 3) to a model's, the farthest pair after the best rotation."""

    def frame(x: FloatArray, i: int, j: int) -> FloatArray:
        second = unit((x[j] - (x[j] @ x[i]) * x[i])[None])[0]
        return np.stack([x[i], second, np.cross(x[i], second)])

    best = 180.0
    for i, j in permutations(range(8), 2):
        placed = model @ frame(model, i, j).T @ frame(points, 0, 1)
        for _ in range(3):
            row, column = linear_sum_assignment(-points @ placed.T)
            left, _, right = np.linalg.svd(points[row].T @ model[column])
            proper = np.diag([1.0, 1.0, np.linalg.det(left @ right)])
            placed = model @ (left @ proper @ right).T
        cosine = (points[row] * placed[column]).sum(axis=1)
        best = min(best, float(np.degrees(np.arccos(np.clip(cosine, -1, 1))).max()))
    return best


def row(method: str, subdivisions: int) -> str:
    """The line of the table for one method on one sphere."""
    surface = BUILTIN["sphere"](subdivisions=subdivisions)
    models = anticube(), cube()
    misfits, seconds = [], []
    for seed in range(STARTS):
        start = time.perf_counter()
        found = run(natural_singularities(surface, method, seed))
        seconds.append(time.perf_counter() - start)
        if [s.valence for s in found] == [3] * 8:
            points = unit(surface.positions([s.point for s in found]))
            misfits.append([distance(points, model) for model in models])
    off = np.array(misfits).reshape(-1, 2)
    hits = (off < WITHIN).sum(axis=0)
    print(method, surface.n_vertices, off[:, 0].round(2).tolist(), file=sys.stderr)
    return (
        f"| {method} | {surface.n_vertices:,} | {STARTS} | {len(off)} | {hits[0]} | {hits[1]} "
        f"| {np.median(off[:, 0]):.2f}° | {off[:, 0].max():.2f}° | {np.median(seconds):.1f} |"
    )


def main(path: str) -> None:
    """Write the table into a document."""
    table = "\n".join([HEADER, *(row(*case) for case in CASES)])
    document = Path(path)
    text = document.read_text(encoding="utf-8")
    before, after = text.split(BEGIN)[0], text.split(END)[1]
    document.write_text(f"{before}{BEGIN}\n{table}\n{END}{after}", encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1])
