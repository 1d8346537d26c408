"""crossview render and crossview gallery: cases to pictures."""

from __future__ import annotations

import contextlib
import re
from collections.abc import Generator
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from crossview.cases import gallery as cases
from crossview.cases.model import Case
from crossview.cli.options import Flag, Output, chosen_case, mesh_options
from crossview.cli.terminal import say, watch
from crossview.io.staged_files import staged
from crossview.workflow.layout import layout, layout_soon
from crossview.workflow.pipeline import Solution, solve_case
from crossview.workflow.quads import MeshOptions, quads_of
from solvers.errors import CrossviewError
from solvers.layouts.errors import LayoutError
from solvers.layouts.layout import QuadLayout
from solvers.progress import Progress
from solvers.quads.quadmesh import QuadMesh

FIGURE, QUADS = "figure.png", "quads.png"
QUAD_LAYERS = ("quads", "singularities", "boundary", "legend", "axes")
COARSE = MeshOptions(target_quads=1500)
"""Of the gallery: quads that can be told apart in a picture."""


def render(
    case: str,
    /,
    *,
    output: Output,
    method: str | None = None,
    features: float | None = None,
    layers: str | None = None,
    size: str = "1600x1200",
    scale: float = 1.0,
    transparent: Flag = False,
    camera: str = "auto",
    edge_length: float | None = None,
    target_quads: int | None = None,
    collapse: Flag = False,
    component: str | None = None,
    repair: Flag = False,
    quiet: Flag = False,
) -> None:
    """Solve a case and draw it to a picture.

    Parameters
    ----------
    case
        A case, a surface without singularities, or the name of a gallery case.
    output
        The picture: .png, or .svg or .pdf with curves and crosses as vectors.
    method
        isotropic, aligned, anisotropic or alternating, instead of the case's.
    features
        Degrees: edges over which the surface bends by more are to be followed, as are the curves
        that the case marks.
    layers
        What to draw, such as H,crosses,singularities,cut; by default what the window shows. layout
        draws the patches, quads the quad mesh.
    size
        Width and height, such as 1600x1200.
    scale
        Pixels for each of size: 2 makes a picture twice as fine.
    transparent
        Leave the background out.
    camera
        auto, iso, xy, xz, yz, or position, focus and up as nine numbers with commas.
    edge_length
        For the layer quads: mean length of their edges.
    target_quads
        About how many quads; 5000 if neither is given.
    collapse
        Let parts of the layout vanish where that gives a coarser mesh.
    component
        Of a surface in several pieces: largest, or a number (0 is the largest).
    repair
        Also mend what cannot be mended without changing the surface.
    quiet
        Show neither progress nor summary.
    """
    from crossview.export.figures import check, shows_curves
    from crossview.export.figures import render as draw

    whole = chosen_case(case, method, repair=repair, features=features)
    found = chosen_case(case, method, component, repair, features)
    if found.options.component == "all":
        raise CrossviewError("a picture shows one component", "all", "name one with --component")
    shown = None if layers is None else [name.strip() for name in layers.split(",")]
    wanted = mesh_options(
        "quads" in (shown or ()), edge_length, target_quads, collapse, "draw --layers quads"
    )
    pixels, target = _size(size), Path(output)
    check(target, layers=shown, size=pixels, scale=scale, camera=camera)

    def work(path: Path) -> Generator[Progress, None, Solution]:
        solution = yield from _component_of(whole, found)
        made, quads = None, None
        if wanted is not None:
            solution, made, quads = yield from quads_of(solution, wanted)
        elif "layout" in (shown or ()):
            made = yield from layout(solution)
        elif shows_curves(shown):
            made = yield from layout_soon(solution)
        yield Progress("drawing", 0.9)
        draw(
            solution,
            path,
            layers=shown,
            size=pixels,
            scale=scale,
            transparent=transparent,
            camera=camera,
            layout=made,
            quads=quads,
        )
        return solution

    with staged(target.parent) as staging:
        watch(work(staging / target.name), quiet)
    if not quiet:
        say(f"wrote {output}")


def _component_of(whole: Case, found: Case) -> Generator[Progress, None, Solution]:
    """Solve the component that is to be drawn.

    A case of all components may have singularities on others, so all are solved.
    """
    if whole.options.component != "all":
        (solution,) = yield from solve_case(found)
        return solution
    solutions = yield from solve_case(whole)
    number = found.options.component
    number = number if isinstance(number, int) else 0  # the largest
    if number >= len(solutions):
        raise CrossviewError(f"there is no component {number}", f"of {len(solutions)}")
    return solutions[number]


def gallery(
    *names: str,
    output: Annotated[str | None, Parameter(name=["--output", "-o"])] = None,
    list_: Annotated[bool, Parameter(name="--list", negative="")] = False,
    quiet: Flag = False,
) -> None:
    """Solve and draw gallery cases, each into a folder of its own with a report.

    Those whose field is aligned and integrable get quads, too.

    Parameters
    ----------
    names
        Which cases; all of them if none is named.
    output
        Folder for the results.
    list_
        Only list the cases.
    quiet
        Show neither progress nor summary.
    """
    paths = {name: cases.path_of(name) for name in names or cases.names()}
    if list_:
        for name in paths:
            say(f"{name:16} {chosen_case(str(paths[name])).title}".rstrip())
        return
    if output is None:
        raise CrossviewError("no folder for the results", "", "name one with -o, or --list")
    from crossview.export.figures import render as draw
    from crossview.export.report import quads_summary, summary, write_files

    def work(
        name: str, directory: Path
    ) -> Generator[Progress, None, tuple[Solution, QuadLayout | None, QuadMesh | None]]:
        (solution,) = yield from solve_case(chosen_case(str(paths[name])))
        made, quads = None, None
        with contextlib.suppress(LayoutError):  # the summary tells that the field is not valid
            solution, made, quads = yield from quads_of(solution, COARSE)
        yield Progress(f"drawing {name}", 0.9)
        write_files(solution, directory, made, quads)
        draw(solution, directory / FIGURE, layout=made)
        if quads is not None:
            draw(solution, directory / QUADS, layers=QUAD_LAYERS, quads=quads)
        return solution, made, quads

    for name in paths:
        with staged(Path(output) / name) as staging:
            solution, made, quads = watch(work(name, staging), quiet)
        if not quiet:
            say(f"{name}: {summary(solution)}")
            if made is not None and quads is not None:
                say(f"{name}: {quads_summary(made, quads)}")


def _size(text: str) -> tuple[int, int]:
    sides = re.fullmatch(r"(\d{1,6})[xX](\d{1,6})", text.strip())
    if sides is None:
        raise CrossviewError(f'unknown size "{text}"', "--size", "write width x height: 1600x1200")
    return int(sides[1]), int(sides[2])
