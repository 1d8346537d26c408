"""crossview render: cases to pictures."""

from __future__ import annotations

import re
from collections.abc import Generator
from dataclasses import replace
from pathlib import Path

from crossview.cases.model import Case
from crossview.cases.pictured import Pictured
from crossview.cli.options import CaseOptions, Flag, Output, QuadOptions, Quiet
from crossview.cli.terminal import say, watch
from crossview.io.staged_files import staged_file
from crossview.workflow.layout import layout, layout_soon
from crossview.workflow.pipeline import Solution, solve_case
from crossview.workflow.quads import quads_of
from solvers.errors import CrossviewError
from solvers.progress import Progress


def render(
    case: str,
    /,
    *,
    output: Output,
    chosen: CaseOptions = CaseOptions(),
    layers: str | None = None,
    size: str = "1600x1200",
    scale: float = 1.0,
    transparent: Flag = False,
    camera: str = "auto",
    sizes: QuadOptions = QuadOptions(),
    quiet: Quiet = False,
) -> None:
    """Solve a case and draw it to a picture.

    Parameters
    ----------
    case
        A case, a surface without singularities, or the name of a gallery case.
    output
        The picture: .png, or .svg or .pdf with curves and crosses as vectors.
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
        auto, iso, xy, xz, yz or from behind yx, zx, zy; or position, focus and up as nine numbers
        with commas, a tenth (half the height seen) for a parallel view.
    """
    from crossview.export.figures import check, shows_curves
    from crossview.export.figures import render as draw

    whole = replace(chosen, component=None).case(case)
    found = chosen.case(case)
    if found.options.component == "all":
        raise CrossviewError("a picture shows one component", "all", "name one with --component")
    shown = None if layers is None else [name.strip() for name in layers.split(",")]
    wanted = sizes.wanted("quads" in (shown or ()), "draw --layers quads")
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
            about=Pictured(found, camera).words(target.parent),
        )
        return solution

    with staged_file(target) as made:
        watch(work(made), quiet)
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


def _size(text: str) -> tuple[int, int]:
    sides = re.fullmatch(r"(\d{1,6})[xX](\d{1,6})", text.strip())
    if sides is None:
        raise CrossviewError(f'unknown size "{text}"', "--size", "write width x height: 1600x1200")
    return int(sides[1]), int(sides[2])
