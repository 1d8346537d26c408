"""crossview animate: cases to animations."""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Group, Parameter

from crossview.cli.options import CaseOptions, Output, Quiet
from crossview.cli.render import PictureOptions
from crossview.cli.terminal import say, watch
from crossview.io.staged_files import staged_file
from crossview.workflow.problem import Problem
from solvers.errors import CrossviewError
from solvers.number_checks import whole_number
from solvers.progress import Progress, between

if TYPE_CHECKING:
    from PIL.Image import Image

    from crossview.export.films import Drag

WHAT = Group("What moves (the turntable if none is chosen)", sort_key=-1)
"""Where the help lists what is animated."""

SMALL = PictureOptions(size="640x480")
"""Animations are smaller than pictures."""

Moves = Annotated[bool, Parameter(negative="", show_default=False, group=WHAT)]


def animate(
    case: str,
    /,
    *,
    output: Output,
    turntable: Moves = False,
    iterations: Moves = False,
    make_valid: Moves = False,
    drag: Annotated[str | None, Parameter(group=WHAT)] = None,
    frames: int = 48,
    fps: float = 16.0,
    picture: PictureOptions = SMALL,
    chosen: CaseOptions = CaseOptions(),
    quiet: Quiet = False,
) -> None:
    """Solve a case and draw it to an animation, which runs again and again.

    Parameters
    ----------
    case
        A case, a surface without singularities, or the name of a gallery case.
    output
        .gif, .png (APNG), .webp, or .mp4 where the program ffmpeg is installed.
    turntable
        Once around the surface.
    iterations
        From the aligned field to the integrable one; of the methods anisotropic and alternating.
    make_valid
        Singularities on their way to where every holonomy defect vanishes.
    drag
        One singularity on a way over the surface: its number, then places, such as
        "1: 0.5,0,0 0,0.5,0".
    frames
        Pictures of a turntable and of a drag.
    fps
        Pictures in a second.
    """
    from crossview.export import films
    from crossview.export.alike import one_camera, with_one_range
    from crossview.export.animation import check_film, write_film
    from crossview.export.figures import check_picture, solution_view
    from crossview.export.raster import shots
    from crossview.view.geometry import Triangles
    from crossview.view.layer_words import read_settings

    if sum((turntable, iterations, make_valid, drag is not None)) > 1:
        raise CrossviewError("one thing moves at a time", "", "choose one of them")
    target, size = Path(output), picture.pixels
    check_film(target, size, fps)
    check_picture(layers=picture.shown, camera=picture.camera)
    frames = whole_number("--frames", frames, 2, 1000)
    settings, way = read_settings(picture.set_), None if drag is None else _drag(drag, frames)
    problem = Problem.from_case(chosen.case(case))

    def solving() -> films.Solving:
        if iterations:
            return films.iterations(problem)
        if make_valid:
            return films.way_to_validity(problem)
        return films.still(problem) if way is None else films.dragged(problem, way)

    def work(path: Path) -> Generator[Progress, None, int]:
        solved = yield from between(solving(), 0.0, 0.5)
        views = [
            replace(
                solution_view(
                    solution,
                    layers=picture.shown,
                    background=picture.background,  # type: ignore[arg-type]
                    settings=settings,
                ),
                title=f"E = {solution.field.energy:.2g}" if iterations else "",
            )
            for solution in solved
        ]
        views = with_one_range(views)
        first = one_camera(views, size, picture.camera)
        cameras = [first] * len(views)
        if len(views) == 1:
            triangles = Triangles(problem.surface.vertices, problem.surface.faces)
            cameras = films.turntable(first, triangles, size, frames)
            views = views * frames
        drawn: list[Image] = []
        for image in shots(zip(views, cameras, strict=True), size):
            yield Progress("drawing", 0.5 + 0.45 * len(drawn) / len(views))
            drawn.append(image)
        yield Progress("writing", 0.95)
        write_film(drawn, path, size, fps)
        return len(drawn)

    with staged_file(target) as made:
        count = watch(work(made), quiet)
    if not quiet:
        say(f"wrote {output}, {count} pictures")


def _drag(words: str, frames: int) -> Drag:
    """Read which singularity is dragged where."""
    from crossview.export.films import Drag

    number, _, places = words.partition(":")
    try:
        found = []
        for place in places.split():
            x, y, z = map(float, place.split(","))
            found.append((x, y, z))
        which = int(number)
    except ValueError:
        found, which = [], 0
    if not found:
        raise CrossviewError(f'no way "{words}"', "--drag", 'write it as "1: 0.5,0,0 0,0.5,0"')
    return Drag(which, found, frames)
