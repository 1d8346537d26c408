"""crossview render: cases to pictures."""

from __future__ import annotations

import re
from collections.abc import Generator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import Group, Parameter

from crossview.cases.model import Case
from crossview.cases.pictured import Pictured
from crossview.cli.options import CaseOptions, Flag, Output, QuadOptions, Quiet
from crossview.cli.terminal import say, watch
from crossview.io.staged_files import staged_file
from crossview.workflow.layout import layout, layout_soon
from crossview.workflow.pipeline import Solution, solve_case
from crossview.workflow.quads import MeshOptions, quads_of
from solvers.errors import CrossviewError
from solvers.progress import Progress, between

if TYPE_CHECKING:
    from crossview.scene import SceneView

PICTURE = Group("Picture", sort_key=0)
"""Where the help lists options of pictures."""


@Parameter(name="*", group=PICTURE)
@dataclass(frozen=True)
class PictureOptions:
    """What is drawn, and how.

    Parameters
    ----------
    layers
        What to draw, such as H,crosses,singularities,cut; by default what the window shows. layout
        draws the patches, quads the quad mesh.
    set_
        How a layer is drawn: crosses.size=2, crosses.density=0.5, H.color_map=roma,
        H.value_range=-1:1, quads.coloring=patch, surface.edges=yes, ...; may be given often.
    size
        Width and height, such as 1600x1200; of each case if there are several.
    camera
        auto, iso, xy, xz, yz or from behind yx, zx, zy; or position, focus and up as nine numbers
        with commas, a tenth (half the height seen) for a parallel view.
    background
        white or dark.
    """

    layers: str | None = None
    set_: Annotated[tuple[str, ...], Parameter(name="--set", negative="")] = ()
    size: str = "1600x1200"
    camera: str = "auto"
    background: str = "white"

    @property
    def shown(self) -> list[str] | None:
        """Names of layers, if some are chosen."""
        return None if self.layers is None else [name.strip() for name in self.layers.split(",")]

    @property
    def pixels(self) -> tuple[int, int]:
        """Width and height.

        Raises
        ------
        CrossviewError
            It is no size.
        """
        sides = re.fullmatch(r"(\d{1,6})[xX](\d{1,6})", self.size.strip())
        if sides is None:
            raise CrossviewError(
                f'unknown size "{self.size}"', "--size", "write width x height: 1600x1200"
            )
        return int(sides[1]), int(sides[2])


def render(
    case: str,
    /,
    *beside: str,
    output: Output,
    picture: PictureOptions = PictureOptions(),
    scale: float = 1.0,
    dpi: float | None = None,
    transparent: Flag = False,
    chosen: CaseOptions = CaseOptions(),
    sizes: QuadOptions = QuadOptions(),
    quiet: Quiet = False,
) -> None:
    """Solve a case and draw it to a picture; several side by side, with one camera and range.

    Parameters
    ----------
    case
        A case, a surface without singularities, or the name of a gallery case.
    beside
        Others, drawn to its right.
    output
        The picture: .png, .svg or .pdf with curves and crosses as vectors, or .html, a page that
        turns in a browser.
    scale
        Pixels for each of size: 2 makes a picture twice as fine.
    dpi
        Pixels per inch: how large it says it is on paper.
    transparent
        Leave the background out.
    """
    from crossview.export.figures import check, render_view
    from crossview.view.layer_words import read_settings

    targets, settings = (case, *beside), read_settings(picture.set_)
    wanted = sizes.wanted("quads" in (picture.shown or ()), "draw --layers quads")
    target = Path(output)
    check(
        target, layers=picture.shown, size=picture.pixels, scale=scale, camera=picture.camera,
        dpi=dpi,
    )  # fmt: skip
    how: dict[str, Any] = {
        "layers": picture.shown,
        "background": picture.background,
        "transparent": transparent,
        "settings": settings,
    }
    found = [_found(chosen, each) for each in targets]

    def work(path: Path) -> Generator[Progress, None, None]:
        views = []
        for number, (whole, one) in enumerate(found):
            made = _view(whole, one, wanted, how, title=_title(one, targets[number], targets))
            first, last = number / len(found), (number + 1) / len(found)
            views.append((yield from between(made, 0.9 * first, 0.9 * last)))
        yield Progress("drawing", 0.9)
        render_view(
            views[0],
            path,
            beside=views[1:],
            size=picture.pixels,
            scale=scale,
            camera=picture.camera,
            dpi=dpi,
            about=Pictured(found[0][1], picture.camera).words(target.parent),
        )

    with staged_file(target) as made:
        watch(work(made), quiet)
    if not quiet:
        say(f"wrote {output}")


def _found(chosen: CaseOptions, target: str) -> tuple[Case, Case]:
    """A case with all its components, and with the one that is drawn."""
    found = chosen.case(target)
    if found.options.component == "all":
        raise CrossviewError("a picture shows one component", "all", "name one with --component")
    return replace(chosen, component=None).case(target), found


def _title(case: Case, target: str, targets: Sequence[str]) -> str:
    """What is written over a case that is not alone."""
    return "" if len(targets) == 1 else case.title or Path(target).stem


def _view(
    whole: Case, found: Case, wanted: MeshOptions | None, how: dict[str, Any], title: str
) -> Generator[Progress, None, SceneView]:
    """Solve a case, with the layout and the quads that are drawn."""
    from crossview.export.figures import shows_curves, solution_view

    shown = how["layers"]
    solution = yield from _component_of(whole, found)
    made, quads = None, None
    if wanted is not None:
        solution, made, quads = yield from quads_of(solution, wanted)
    elif "layout" in (shown or ()):
        made = yield from layout(solution)
    elif shows_curves(shown):
        made = yield from layout_soon(solution)
    return replace(solution_view(solution, layout=made, quads=quads, **how), title=title)


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
