"""What several commands take: their options, each with its help, and what they choose."""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import asdict, dataclass
from typing import Annotated, Any, TypeVar

from cyclopts import Group, Parameter

from crossview.cases.gallery import find_case
from crossview.cases.model import Case
from crossview.cli.terminal import say, watch
from crossview.workflow.coarseness import coarseness
from crossview.workflow.problem import Problem
from crossview.workflow.quads import MeshOptions
from solvers.errors import CrossviewError
from solvers.progress import Progress
from solvers.quads import MAX_CHORD, MAX_SIZE_RATIO

T = TypeVar("T")

Output = Annotated[str, Parameter(name=["--output", "-o"])]
Flag = Annotated[bool, Parameter(negative="", show_default=False)]
Json = Annotated[bool, Parameter(name="--json", negative="", show_default=False)]
Quiet = Annotated[
    bool,
    Parameter(negative="", show_default=False, help="Show neither progress nor summary."),
]

CASE = Group("Surface and field", sort_key=1)
"""Where the help lists options of the surface and its field."""

QUADS = Group("Quads", sort_key=2)
"""Where the help lists options of quads."""


@Parameter(name="*", group=CASE)
@dataclass(frozen=True)
class SurfaceOptions:
    """Which surface is taken of a file.

    Parameters
    ----------
    component
        Of a surface in several pieces: largest, a number (0 is the largest) or, for info and
        solve, all.
    repair
        Also cut the surface apart at non-manifold edges and vertices.
    """

    component: str | None = None
    repair: Flag = False

    def case(self, target: str) -> Case:
        """Return the case that `target` names, with what these options say instead.

        Raises
        ------
        CrossviewError
            There is no such case, or an option is wrong.
        """
        chosen: dict[str, Any] = asdict(self)
        if self.component is not None and self.component.isdecimal():
            chosen["component"] = int(self.component)
        return find_case(target).with_choices(**chosen, prefix="--")


@Parameter(name="*", group=CASE)
@dataclass(frozen=True)
class FeatureOptions(SurfaceOptions):
    """The same, and which edges are features.

    Parameters
    ----------
    features
        Degrees: edges over which the surface bends by more are to be followed, as are the curves
        that the case marks.
    """

    features: float | None = None


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class NewCase:
    """What commands take that make a case of another by placing its singularities anew.

    Parameters
    ----------
    output
        The new case file.
    """

    output: Output
    chosen: FeatureOptions = FeatureOptions()
    quiet: Quiet = False

    def watch(self, computation: Generator[Progress, None, T]) -> T:
        """Run a computation, as `crossview.cli.terminal.watch`."""
        return watch(computation, self.quiet)

    def gained(self, before: Problem, after: Problem) -> str:
        """Return how coarse the layouts of two problems are, in words; nothing if it is not told.

        Parameters
        ----------
        before, after : Problem
            Valid.
        """
        if self.quiet:
            return ""
        told = (self.watch(coarseness(problem)) for problem in (before, after))
        return " -> ".join(str(found or "no layout") for found in told)

    def write(self, found: Case, made: Problem, summary: str) -> None:
        """Write the new case and say what came of it.

        Parameters
        ----------
        found : Case
            The one it is made of.
        made : Problem
            With its singularities placed anew.
        summary : str
            The line on it, without the file.
        """
        made.to_case(found.surface, found.title).save(self.output)
        if not self.quiet:
            say(f"{summary}; wrote {self.output}")


@Parameter(name="*", group=CASE)
@dataclass(frozen=True)
class CaseOptions(FeatureOptions):
    """The same, and how the field is solved.

    Parameters
    ----------
    method
        isotropic, aligned, anisotropic or alternating, instead of the case's.
    """

    method: str | None = None


@Parameter(name="*", group=QUADS)
@dataclass(frozen=True)
class QuadOptions:
    """How fine the quads are.

    Parameters
    ----------
    edge_length
        Mean length of the quads' edges.
    target_quads
        About how many quads; 5000 if neither is given.
    max_chord
        Largest distance of an edge from the boundary or feature that it follows, in radii of its
        bend; 0.01 if not given.
    max_size_ratio
        How much longer than the mean edge of all those along an arc of the layout may be, as far
        as the number of quads allows; 4 if not given.
    """

    edge_length: float | None = None
    target_quads: int | None = None
    max_chord: float | None = None
    max_size_ratio: float | None = None

    def wanted(self, quads: bool, advice: str) -> MeshOptions | None:
        """Return how the quads are to be; None if none are wanted.

        Parameters
        ----------
        quads : bool
            Whether they are.
        advice : str
            What to write on the command line where they are meant to be.

        Raises
        ------
        CrossviewError
            None are wanted and it is said how they should be, or something is impossible.
        """
        if quads:
            chord = MAX_CHORD if self.max_chord is None else self.max_chord
            ratio = MAX_SIZE_RATIO if self.max_size_ratio is None else self.max_size_ratio
            return MeshOptions(
                self.edge_length, self.target_quads, max_chord=chord, max_size_ratio=ratio
            )
        for name, given in vars(self).items():
            if given is not None:
                raise CrossviewError(f"--{name.replace('_', '-')} is about quads", "", advice)
        return None
