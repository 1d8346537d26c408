"""The frozen state of one session: a problem on a surface and where it came from."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

from crossview.cases.model import Case
from crossview.workflow.problem import Problem
from solvers.singularities import (
    Connections,
    Existence,
    IndexBudget,
    Singularity,
    existence,
    index_budget,
)
from solvers.surface import TriSurface
from solvers.validity import fewest_left

EDITED = ", edited"
"""Ends the title of a case whose configuration is no longer as it says."""


@dataclass(frozen=True, eq=False)
class Document:
    """What undo and redo move between.

    Parameters
    ----------
    name : str
        What the user calls it: the file or gallery case.
    problem : Problem
        Surface, singularities, corners, method and options.
    corners : mapping of int to int
        Boundary vertex -> index, chosen once per surface where ``problem.corners`` is None.
    source : Case
        What it was opened from; names the surface when the case is saved.
    described : Problem or None
        What the title of `source` says something about.
    """

    name: str
    problem: Problem
    corners: Mapping[int, int]
    source: Case
    described: Problem | None = None

    @classmethod
    def from_case(cls, name: str, case: Case) -> Document:
        """Load the surface of `case` and place its singularities and corners."""
        problem = Problem.from_case(case)
        return cls(name, problem, problem.chosen_corners, case, problem)

    def to_case(self) -> Case:
        """Return the case that opens as this document."""
        return self.problem.to_case(self.source.surface, self.title)

    @property
    def title(self) -> str:
        """The title of the case; what it says of the configuration is of before any edit."""
        title, described = self.source.title, self.described
        same = described is not None and self.problem.same_but_method(described)
        return title if same or not title or title.endswith(EDITED) else title + EDITED

    @property
    def surface(self) -> TriSurface:
        """The surface as it was read, before any refinement."""
        return self.problem.surface

    @property
    def singularities(self) -> tuple[Singularity, ...]:
        """The imposed singularities, on `surface`."""
        return tuple(self.problem.singularities)

    @cached_property
    def budget(self) -> IndexBudget:
        """The index sum against 4 chi (Poincare-Hopf)."""
        return index_budget(self.surface, self.singularities, self.corners)

    @cached_property
    def fewest(self) -> int:
        """How many singularities merging leaves at the least."""
        return fewest_left(self.singularities, self.problem.features)

    @cached_property
    def existence(self) -> Existence:
        """Whether any quad mesh has its singularities, corners and turns, by topology."""
        return self.existence_with(self.singularities)

    def existence_with(self, singularities: Sequence[Singularity]) -> Existence:
        """Whether any quad mesh has other singularities in their place."""
        turning = any(s.index for s in singularities)
        turns = None if turning else self.problem.known_turns
        return existence(self.surface, singularities, self.corners, turns)

    @property
    def connections(self) -> Connections:
        """Which of the singularities are to stay joined."""
        return self.problem.connections

    def with_singularities(
        self, singularities: Sequence[Singularity], connections: Connections = ()
    ) -> Document:
        """Return the same document with other singularities, some of them to stay joined."""
        problem = replace(self.problem, singularities=tuple(singularities), connections=connections)
        return replace(self, problem=problem)

    def with_title(self, title: str) -> Document:
        """Return the same document with a title that is of its configuration."""
        source = replace(self.source, title=title)
        return replace(self, source=source, described=self.problem)

    def with_corners(self, corners: Mapping[int, int]) -> Document:
        """Return the same document with other corners."""
        return replace(self, problem=replace(self.problem, corners=corners), corners=corners)

    def with_turns(self, turns: Sequence[int]) -> Document:
        """Return the same document with other quarter turns over the holonomy conditions."""
        options = replace(self.problem.options, turns=tuple(turns))
        return replace(self, problem=replace(self.problem, options=options))

    def with_automatic_corners(self) -> Document:
        """Return the same document with corners chosen from the boundary's angles."""
        if self.problem.corners is None:
            return self
        problem = replace(self.problem, corners=None)
        return replace(self, problem=problem, corners=problem.chosen_corners)
