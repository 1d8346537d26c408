"""crossview gallery: the cases that come with it, drawn and held against what is expected."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from crossview.cases import gallery as cases
from crossview.cases.model import Case
from crossview.cli.options import Quiet
from crossview.cli.terminal import complain, say, watch
from solvers.errors import CrossviewError

if TYPE_CHECKING:
    from crossview.studies.exhibition import Exhibited

PAGE = "index.html"
"""Name of the page of all cases."""


def gallery(
    *names: str,
    output: Annotated[str | None, Parameter(name=["--output", "-o"])] = None,
    list_: Annotated[bool, Parameter(name="--list", negative="")] = False,
    quiet: Quiet = False,
) -> int:
    """Solve, draw and check gallery cases; write a page of pictures, figures, pass or fail.

    Exits with status 1 where something is not as the gallery expects it.

    Parameters
    ----------
    names
        Which cases; all of them if none is named.
    output
        Folder for index.html, and for the pictures and files of each case.
    list_
        Only list the cases.
    """
    for name in names:
        cases.path_of(name)  # or there is none of that name
    chosen = names or cases.names()
    if list_:
        for name in chosen:
            say(f"{name:22} {Case.load(cases.path_of(name)).title}".rstrip())
        return 0
    if output is None:
        raise CrossviewError("no folder for the results", "", "name one with -o, or --list")
    from crossview.io.staged_files import staged_file
    from crossview.studies.exhibition import exhibition
    from crossview.studies.gallery_page import gallery_page

    shown = watch(exhibition(chosen, Path(output)), quiet)
    with staged_file(Path(output) / PAGE) as made:
        made.write_text(gallery_page(shown), encoding="utf-8")
    for each in shown:
        _tell(each, quiet)
    right = sum(each.passed for each in shown)
    if not quiet:
        say(f"{right} of {len(shown)} as expected; wrote {Path(output) / PAGE}")
    return 0 if right == len(shown) else 1


def _tell(each: Exhibited, quiet: bool) -> None:
    """Say what came of a case, and what is not as expected."""
    name = each.exhibit.case
    for check in each.checks:
        if not check.passed:
            complain(f"{name}: {check.figure} is {check.found}, to be {check.wanted}")
    if not quiet:
        for line in each.lines:
            say(f"{name}: {line}")
