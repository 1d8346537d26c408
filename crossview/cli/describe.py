"""A surface described as JSON values, also one that cannot be solved on."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from crossview.cases.model import Builtin, Case
from crossview.io import RawSurface, read_surface
from crossview.workflow.loading import load_surfaces, mended
from crossview.workflow.problem import Problem, problems_on
from solvers.errors import CrossviewError, SurfaceError
from solvers.remedies import RepairSurface
from solvers.repair import NoComponent, Repaired, share_vertices
from solvers.singularities import existence, index_budget
from solvers.surface import problems


def describe(case: Case) -> dict[str, Any]:
    """What the surface of a case is, what is wrong with it, and what its indices must sum to.

    All components are described unless the case chooses one. "problems" are those of the file's
    own triangles (joined along seams), "notes" is what was mended; "components" is empty if the
    rest keeps the triangles from being a surface; "usable" is "yes", "with repair" or "no".

    Raises
    ------
    CrossviewError
        The surface cannot be read, or the case places something away from it.
    """
    if case.options.component is None:
        case = replace(case, options=replace(case.options, component="all"))
    if isinstance(case.surface, Builtin):
        pieces = load_surfaces(case)
        made = pieces[0].surface
        counts = made.n_vertices, made.n_faces
        found: list[SurfaceError] = []
        usable = "yes"
    else:
        counts, found, pieces, usable = _read(case, case.surface)
    posed = problems_on(case, pieces) if pieces else ()
    return {
        "vertices": counts[0],
        "faces": counts[1],
        "usable": usable,
        "problems": [_problem(error, usable) for error in found],
        "notes": list(pieces[0].notes) if pieces else [],
        "components": [_component(problem) for problem in posed],
    }


def _read(
    case: Case, path: str
) -> tuple[tuple[int, int], list[SurfaceError], tuple[Repaired, ...], str]:
    """Counts of vertices and triangles, their problems, the surfaces made of them, if usable."""
    raw = read_surface(path)
    vertices, faces, _ = share_vertices(raw.vertices, raw.faces, merge=raw.merge)
    found = list(problems(vertices, faces))
    usable = "yes"
    try:
        pieces = mended(raw, case)
    except NoComponent:
        raise
    except SurfaceError as error:
        pieces = ()
        usable = "with repair" if _mendable(raw, case) else "no"
        # a one-sided surface shows only when orienting it is tried
        if not any(_same(error, problem) for problem in found):
            found.append(error)
    return (len(vertices), len(faces)), found, pieces, usable


def _mendable(raw: RawSurface, case: Case) -> bool:
    """Whether the option repair makes surfaces of what was read."""
    try:
        mended(raw, replace(case, options=replace(case.options, repair=True)))
    except SurfaceError:
        return False
    return True


def _same(one: SurfaceError, other: SurfaceError) -> bool:
    return one.kind == other.kind and np.array_equal(one.elements, other.elements)


def _problem(error: SurfaceError, usable: str) -> dict[str, Any]:
    """What is wrong, and what to do about it unless that was done."""
    done = usable == "yes"
    to_do = [r for r in error.remedies if not (done and isinstance(r, RepairSurface))]
    return {
        "message": str(CrossviewError(error.what, error.where, error.advice, remedies=to_do)),
        "kind": error.kind,
        "elements": error.elements.tolist(),
    }


def _component(problem: Problem) -> dict[str, Any]:
    surface, corners = problem.surface, problem.chosen_corners
    budget = index_budget(surface, problem.singularities, corners)
    known = existence(surface, problem.singularities, corners, problem.known_turns)
    quality = surface.triangle_quality
    closed = [np.append(loop, loop[0]) for loop in surface.boundary_loops]
    return {
        "vertices": surface.n_vertices,
        "faces": surface.n_faces,
        "euler_characteristic": surface.euler_characteristic,
        "genus": surface.genus,
        "boundary_loops": len(surface.boundary_loops),
        "boundary_lengths": [
            float(np.linalg.norm(np.diff(surface.vertices[loop], axis=0), axis=1).sum())
            for loop in closed
        ],
        "area": surface.area,
        "diagonal": surface.diagonal,
        "triangle_quality": {
            "min": float(quality.min()),
            "mean": float(quality.mean()),
            "max": float(quality.max()),
        },
        "corners": [
            {"position": surface.vertices[vertex].tolist(), "index": index}
            for vertex, index in corners.items()
        ],
        "index_budget": {
            "index_sum": budget.index_sum,
            "required": budget.required,
            "missing": budget.missing,
            "satisfied": budget.satisfied,
            "message": budget.message,
            "remedies": [remedy.words for remedy in budget.remedies],
        },
        "existence": {
            "answer": known.answer,
            "theorem": None if known.theorem is None else str(known.theorem),
            "remedies": [remedy.words for remedy in known.remedies],
        },
    }
