"""Impose singularities on a surface, solve its boundary-aligned cross-field, and see it live.

The same verbs as on the command line and in the window, from a file to a quad mesh::

    import crossview

    problem = crossview.make_valid(crossview.natural(crossview.read("part.obj")))
    solution = crossview.solve(problem)
    layout = crossview.layout(solution)
    mesh = crossview.quads(layout, 2000)
    crossview.write_mesh(mesh, "quads.msh")
    crossview.render(solution, "figure.pdf", layout=layout, quads=mesh)

The numerics below them are `solvers`; Qt and VTK are loaded when they are wanted.
"""

from __future__ import annotations

from importlib.metadata import version
from typing import TYPE_CHECKING

from solvers.lazy import when_wanted

if TYPE_CHECKING:
    from crossview.cases.model import Case
    from crossview.certificate import Certificate
    from crossview.library import (
        batch,
        check,
        complete,
        improve,
        layout,
        make_valid,
        natural,
        quads,
        read,
        read_surface,
        render,
        report,
        solve,
        write_case,
        write_mesh,
        write_solution,
    )
    from crossview.workflow.problem import Problem
    from crossview.workflow.solution import Solution
    from solvers import CrossviewError, Singularity, SurfacePoint, TriSurface, primitives
    from solvers.layouts import QuadLayout
    from solvers.quads import QuadMesh


__version__ = version("crossview")

__all__ = [
    "Case",
    "Certificate",
    "CrossviewError",
    "Problem",
    "QuadLayout",
    "QuadMesh",
    "Singularity",
    "Solution",
    "SurfacePoint",
    "TriSurface",
    "batch",
    "check",
    "complete",
    "improve",
    "layout",
    "make_valid",
    "natural",
    "primitives",
    "quads",
    "read",
    "read_surface",
    "render",
    "report",
    "solve",
    "write_case",
    "write_mesh",
    "write_solution",
]

__getattr__ = when_wanted(
    __name__,
    {
        "crossview.cases.model": ("Case",),
        "crossview.certificate": ("Certificate",),
        "crossview.library": (
            "batch",
            "check",
            "complete",
            "improve",
            "layout",
            "make_valid",
            "natural",
            "quads",
            "read",
            "read_surface",
            "render",
            "report",
            "solve",
            "write_case",
            "write_mesh",
            "write_solution",
        ),
        "crossview.workflow.problem": ("Problem",),
        "crossview.workflow.solution": ("Solution",),
        "solvers": (
            "CrossviewError",
            "Singularity",
            "SurfacePoint",
            "TriSurface",
            "primitives",
        ),
        "solvers.layouts": ("QuadLayout",),
        "solvers.quads": ("QuadMesh",),
    },
)


def __dir__() -> list[str]:
    """Return the names that there are, also those not wanted yet."""
    return sorted({*globals(), *__all__})
