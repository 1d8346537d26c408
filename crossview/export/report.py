"""What a solution says about itself (report.json), and its fields as files for ParaView."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np

from crossview import __version__
from crossview.export.vtp import cross_lines, cut_lines, field_surface, singularity_points
from crossview.pipeline import Solution
from crossview.staging import staged

REPORT = "report.json"


def report(solution: Solution) -> dict[str, Any]:
    """The report of a solution as JSON values; angles in degrees, indices in quarter turns.

    "surface" is the surface as given, "solved_on" the one refined around the singularities;
    "boundary_misalignment_degrees" follows the order of ``surface.boundary_loops`` of the first.
    "holonomy" and "isotropically_valid" are those of the isotropic field of the configuration,
    whatever the method.
    """
    problem, field = solution.problem, solution.field
    surface, solved_on = problem.surface, solution.surface
    return {
        "crossview": __version__,
        "method": problem.method,
        "surface": {
            "vertices": surface.n_vertices,
            "faces": surface.n_faces,
            "euler_characteristic": surface.euler_characteristic,
            "genus": surface.genus,
            "boundary_loops": len(surface.boundary_loops),
        },
        "solved_on": {"vertices": solved_on.n_vertices, "faces": solved_on.n_faces},
        "notes": list(problem.notes),
        "singularities": _singularities(solution),
        "corners": [
            {"position": _floats(surface.vertices[vertex]), "index": index}
            for vertex, index in problem.chosen_corners.items()
        ],
        "index_sum": field.index_sum,
        "index_required": field.index_required,
        "holonomy": [
            {"kind": c.kind, "label": c.label, "defect_degrees": float(np.degrees(defect))}
            for c, defect in zip(
                solution.solver.holonomy.conditions, solution.holonomy_defects, strict=True
            )
        ],
        "tolerance_degrees": problem.options.tolerance_degrees,
        "isotropically_valid": solution.valid,
        "boundary_misalignment_degrees": _floats(np.degrees(_by_loop(solution))),
        **_integrability(solution),
        "residual": float(field.residual),
        "max_closing_error": float(field.max_closing_error),
        "seconds": {stage: round(time, 6) for stage, time in solution.seconds.items()},
    }


def summary(solution: Solution) -> str:
    """The method, what it reached, and the verdict, in one line."""
    field, verdict = solution.field, solution.verdict
    said = f"{verdict.status}: {solution.problem.method}, "
    said += f"index {field.index_sum} of {field.index_required}, "
    if solution.integrated is None:
        said += _defects(solution)
    elif field.convergence.energies:
        steps = len(field.convergence.energies) - 1
        said += f"E {field.convergence.energies[0]:.3g} -> {field.energy:.3g}, {steps} steps"
        said += "" if field.convergence.converged else ", not converged"
    else:
        said += f"E {field.energy:.3g}"
    return said if verdict.status == "valid" else f"{said}. {verdict.reason}"


def _defects(solution: Solution) -> str:
    """The holonomy defects of the configuration in a few words."""
    tolerance = solution.problem.options.tolerance_degrees
    defects = np.abs(np.degrees(solution.holonomy_defects))
    if not defects.size:
        return "no holonomy condition on this surface"
    if solution.valid:
        return f"{defects.size} holonomy defects below {tolerance:g} degrees"
    worst = solution.solver.holonomy.conditions[int(defects.argmax())]
    off = int((defects >= tolerance).sum())
    return (
        f"{off} of {defects.size} holonomy defects not below {tolerance:g} degrees, "
        f"the worst {defects.max():.3f} degrees ({worst.label})"
    )


def write_solution(solution: Solution, directory: str | Path) -> None:
    """Write report.json, surface.vtp, crosses.vtp, cut_graph.vtp and singularities.vtp.

    All or nothing: the files are moved to `directory` when the last of them is complete.

    Raises
    ------
    CrossviewError
        `directory` cannot be made or written.
    """
    with staged(directory) as staging:
        write_files(solution, staging)


def write_files(solution: Solution, directory: Path) -> None:
    """Write the files of `write_solution` one by one into an existing folder."""
    field_surface(solution).save(directory / "surface.vtp")
    cross_lines(solution).save(directory / "crosses.vtp")
    cut_lines(solution).save(directory / "cut_graph.vtp")
    singularity_points(solution).save(directory / "singularities.vtp")
    text = json.dumps(report(solution), indent=2, ensure_ascii=False, allow_nan=False)
    (directory / REPORT).write_text(text + "\n", encoding="utf-8")


def _integrability(solution: Solution) -> dict[str, Any]:
    """E before and after, and the verdict."""
    field = solution.field
    history = _floats(field.convergence.energies)
    return {
        "energy_initial": history[0] if history else field.energy,
        "energy_final": field.energy,
        "energy_history": history,
        "iterations": max(len(history) - 1, 0),
        "converged": field.convergence.converged,
        "max_log_aspect": field.max_log_aspect,
        "aspect_growth": solution.growth,
        "flips": solution.flips,
        "verdict": solution.verdict.status,
        "verdict_reason": solution.verdict.reason,
    }


def _singularities(solution: Solution) -> list[dict[str, Any]]:
    return [
        {
            "position": _floats(solution.problem.surface.position(s.point)),
            "valence": s.valence,
            "index": s.index,
            "locked": s.locked,
        }
        for s in solution.problem.singularities
    ]


def _by_loop(solution: Solution) -> np.ndarray[Any, Any]:
    """Misalignment of each boundary loop of the given surface.

    Refinement keeps old vertices and their numbers, but loops of equal length may change order.
    """
    refined = solution.surface.boundary_loops
    of_vertex = {int(v): i for i, loop in enumerate(refined) for v in loop}
    order = [of_vertex[int(loop[0])] for loop in solution.problem.surface.boundary_loops]
    return solution.field.boundary_misalignment[order]


def _floats(values: Any) -> list[float]:
    return [float(value) for value in values]
