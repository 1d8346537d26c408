"""What a solution says about itself (report.json), and its fields as files for ParaView."""

from __future__ import annotations

import json
from collections.abc import Sequence
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from crossview.export.field_facts import cut_facts, log_sizes
from crossview.export.meshes import check_kind, write_mesh
from crossview.export.quads_report import quads_report
from crossview.export.vtk_bytes import save_vtk
from crossview.export.vtp import (
    cross_lines,
    cut_lines,
    feature_lines,
    field_surface,
    layout_patches,
    separatrix_lines,
    singularity_points,
)
from crossview.io.staged_files import staged
from crossview.workflow.layout import misaligned_boundaries, separatrices
from crossview.workflow.pipeline import Solution
from solvers.errors import counted
from solvers.features import FeatureCurve
from solvers.kind_checks import all_of_kind
from solvers.layouts import QuadLayout
from solvers.quads import QuadMesh

REPORT = "report.json"
"""The file that a report is written to."""

FORMATS = ("vtk", "obj")
"""Of quad meshes, if no others are asked for."""


def report(
    solution: Solution,
    layout: QuadLayout | None = None,
    quads: QuadMesh | None = None,
    delivered: bool = True,
) -> dict[str, Any]:
    """The report of a solution as JSON values; angles in degrees, indices in quarter turns.

    "surface" is the surface as given, "solved_on" the one refined around the singularities
    (quality of triangles: 1 equilateral, 0 degenerate); "boundary_misalignment_degrees" follows
    the order of ``surface.boundary_loops`` of the first. "holonomy" and "isotropically_valid" are
    those of the isotropic field of the configuration, whatever the method; the "turns" are the
    method's. "log_sizes" are H1 and H2 together; "cut_graph" tells what the surface is opened to.
    "layout" tells of the separatrices, and of patches if a layout is given; "quads" is there if a
    quad mesh is, "delivered" in it whether files of it are written.
    """
    problem, field = solution.problem, solution.field
    surface, solved_on = problem.surface, solution.surface
    return {
        "crossview": version("crossview"),
        "method": problem.method,
        "surface": {
            "vertices": surface.n_vertices,
            "faces": surface.n_faces,
            "euler_characteristic": surface.euler_characteristic,
            "genus": surface.genus,
            "boundary_loops": len(surface.boundary_loops),
        },
        "solved_on": {
            "vertices": solved_on.n_vertices,
            "faces": solved_on.n_faces,
            "min_triangle_quality": float(solved_on.triangle_quality.min()),
            "mean_triangle_quality": float(solved_on.triangle_quality.mean()),
        },
        "notes": list(problem.notes),
        "singularities": _singularities(solution),
        "corners": [
            {"position": _floats(surface.vertices[vertex]), "index": index}
            for vertex, index in problem.chosen_corners.items()
        ],
        "index_sum": field.index_sum,
        "index_required": field.index_required,
        "holonomy": [
            {
                "kind": c.kind,
                "label": c.label,
                "defect_degrees": float(np.degrees(defect)),
                "turns": turns,
            }
            for c, defect, turns in zip(
                solution.solver.holonomy.conditions,
                solution.holonomy_defects,
                solution.turns,
                strict=True,
            )
        ],
        "tolerance_degrees": problem.options.tolerance_degrees,
        "isotropically_valid": solution.valid,
        "boundary_misalignment_degrees": _floats(np.degrees(_by_loop(solution))),
        "features": _features(solution),
        "released_features": [
            {**_curve(solution, curve), "reason": reason}
            for reason, features in solution.released_for.items()
            for curve in features.curves
        ],
        "forced_corners": _forced_corners(solution),
        **_integrability(solution),
        "log_sizes": log_sizes(field),
        "cut_graph": cut_facts(solution),
        "layout": _layout(solution, layout),
        **({} if quads is None else {"quads": quads_report(solution, quads, delivered)}),
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
    if any(solution.turns):
        said += f", turns {', '.join(map(str, solution.turns))}"
    said += _released(solution)
    return said if verdict.status == "valid" else f"{said}. {verdict}"


def _released(solution: Solution) -> str:
    """How many feature curves are not followed, and why."""
    found = {reason: len(features.curves) for reason, features in solution.released_for.items()}
    if not found:
        return ""
    every = counted(len(solution.prepared.features.curves), "feature curve")
    why = ", ".join(f"{reason} ({n})" for reason, n in found.items())
    return f", released {sum(found.values())} of {every}: {why}"


def _defects(solution: Solution) -> str:
    """The holonomy defects of the configuration in a few words."""
    tolerance = solution.problem.options.tolerance_degrees
    defects = np.abs(np.degrees(solution.holonomy_defects))
    if not defects.size:
        return "no holonomy condition on this surface"
    if solution.valid:
        return f"{defects.size} holonomy defects below {tolerance:g} degrees"
    worst = solution.solver.holonomy.conditions[int(defects.argmax())]
    off = int(solution.limits.missed(solution.holonomy_defects).sum())
    return (
        f"{off} of {defects.size} holonomy defects not below {tolerance:g} degrees, "
        f"the worst {defects.max():.3f} degrees ({worst.label})"
    )


def write_solution(
    solution: Solution,
    directory: str | Path,
    layout: QuadLayout | None = None,
    quads: QuadMesh | None = None,
    formats: Sequence[str] = FORMATS,
    *,
    allow_inverted: bool = False,
) -> None:
    """Write report.json and surface, crosses, cut_graph, singularities and separatrices as .vtp.

    With quads also layout.vtp, and the quads in each of the formats. Separatrices are those of the
    layout if one is given. All or nothing: the files are
    moved to `directory` when the last of them is complete.

    Raises
    ------
    CrossviewError
        A format is unknown, a quad is inverted and that is not allowed, or `directory` cannot be
        made or written.
    """
    formats = all_of_kind("formats", formats, str)
    for suffix in formats:
        check_kind(Path(f"quads.{suffix}"))
    with staged(directory) as staging:
        write_files(solution, staging, layout, quads, formats, allow_inverted)


def write_files(
    solution: Solution,
    directory: Path,
    layout: QuadLayout | None = None,
    quads: QuadMesh | None = None,
    formats: Sequence[str] = FORMATS,
    allow_inverted: bool = False,
) -> None:
    """Write the files of `write_solution` one by one into an existing folder."""
    save_vtk(separatrix_lines(separatrices(solution, layout)), directory / "separatrices.vtp")
    save_vtk(field_surface(solution), directory / "surface.vtp")
    save_vtk(cross_lines(solution), directory / "crosses.vtp")
    save_vtk(cut_lines(solution), directory / "cut_graph.vtp")
    save_vtk(singularity_points(solution), directory / "singularities.vtp")
    if len(solution.features):
        save_vtk(feature_lines(solution), directory / "features.vtp")
    if quads is not None:
        if layout is not None:
            save_vtk(layout_patches(layout), directory / "layout.vtp")
        for suffix in formats:
            write_mesh(quads, directory / f"quads.{suffix}", allow_inverted=allow_inverted)
    text = json.dumps(
        report(solution, layout, quads, bool(formats)),
        indent=2,
        ensure_ascii=False,
        allow_nan=False,
    )
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
        "flips": solution.inverted,
        "wrong_windings": solution.wrong_windings,
        "verdict": solution.verdict.status,
        "verdict_reason": str(solution.verdict),
    }


def _layout(solution: Solution, layout: QuadLayout | None) -> dict[str, Any]:
    """The separatrices, what they miss, and the patches between them if there are any."""
    curves = separatrices(solution, layout)
    own = curves.valences >= 0
    return {
        "separatrices": int(np.count_nonzero(own)),
        "t_junctions": len(curves.t_junctions),
        "misaligned_boundaries": len(misaligned_boundaries(solution)[0]),
        "added_curves": int(np.count_nonzero(~own)),
        "patches": None if layout is None else layout.patches,
        "conforming": None if layout is None else layout.conforming,
        "flips": None if layout is None else layout.inverted,
        "stiffened": None if layout is None else layout.mended,
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


def _features(solution: Solution) -> list[dict[str, Any]]:
    """The feature curves and by how much the crosses miss each."""
    off = np.degrees(solution.field.feature_misalignment)
    return [
        {**_curve(solution, curve), "misalignment_degrees": float(angle)}
        for curve, angle in zip(solution.features.curves, off, strict=True)
    ]


def _curve(solution: Solution, curve: FeatureCurve) -> dict[str, Any]:
    """Where a feature curve is."""
    places = solution.surface.vertices[curve.vertices]
    return {
        "start": _floats(places[0]),
        "end": _floats(places[-1]),
        "closed": curve.closed,
        "length": float(np.linalg.norm(np.diff(places, axis=0), axis=1).sum()),
    }


def _forced_corners(solution: Solution) -> list[list[float]]:
    """Where on features the singularities on both sides do not fit; none for one size."""
    if solution.integrated is None:
        return []
    forced = solution.integrated.aligned.forced_corners
    return [_floats(position) for position in solution.surface.vertices[forced]]


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
