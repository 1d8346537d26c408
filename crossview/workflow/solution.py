"""A solved problem, and what is shared by the methods that may solve it."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from crossview.workflow.problem import Problem
from solvers.features.edges import Features
from solvers.fields.aligned import AlignedField, IntegratedField, aligned_field
from solvers.fields.crossfield import CrossField
from solvers.fields.isotropic import IsotropicSolver
from solvers.fields.verdict import Verdict
from solvers.layouts.layout import QuadLayout
from solvers.layouts.separatrices import Separatrices
from solvers.layouts.turning import joining_turn
from solvers.singularities.budget import Singularity
from solvers.surface.refinement import Refinement
from solvers.surface.triangulation import FloatArray, IntArray
from solvers.surface.trisurface import TriSurface


@dataclass(eq=False)
class Derived:
    """What is made of a solution when it is first asked for, and then kept.

    Attributes
    ----------
    separatrices : Separatrices, or None
        Of the field.
    layout : QuadLayout, or None
    """

    separatrices: Separatrices | None = None
    layout: QuadLayout | None = None


@dataclass(frozen=True, eq=False)
class Solution:
    """A solved problem.

    Attributes
    ----------
    problem : Problem
    refinement : Refinement
        The surface solved on: refined around the singularities, which are vertices of it.
    solver : IsotropicSolver
        Keeps the factorisation of that surface.
    singularities : tuple of Singularity
        On the refined surface, in the order of the problem's.
    field : CrossField
    holonomy_defects : (2 g + max(b - 1, 0),) float array
        Of the isotropic field of the same configuration, whatever the method; radians in
        (-pi/4, pi/4], in the order of ``solver.holonomy.conditions``.
    seconds : mapping of str to float
        Time of each stage; next to nothing for one that was kept.
    integrated : IntegratedField, or None
        The field with its seamless map; None for the isotropic method.
    verdict : Verdict
    growth : float, or None
        Of int |grad s|^2 on a once refined mesh; None if not asked for.
    inverted : int, or None
        Triangles turned over in the seamless map; None where the field has none.
    derived : Derived
        Shared by copies that differ in nothing but their seconds, or an equal problem.
    """

    problem: Problem
    refinement: Refinement
    solver: IsotropicSolver
    singularities: tuple[Singularity, ...]
    field: CrossField
    holonomy_defects: FloatArray
    seconds: Mapping[str, float]
    integrated: IntegratedField | None
    verdict: Verdict
    growth: float | None = None
    inverted: int | None = None
    derived: Derived = dataclasses.field(default_factory=Derived, repr=False)

    @property
    def surface(self) -> TriSurface:
        """The refined surface that was solved on."""
        return self.refinement.surface

    @property
    def features(self) -> Features:
        """The edges of `surface` that crosses are to follow."""
        return self.solver.discretization.features

    @cached_property
    def cut_graph(self) -> IntArray:
        """(k, 2) vertex pairs of `surface` that cut it to a disk and meet every singularity."""
        return self.solver.cut_graph(self.singularities)

    @property
    def valid(self) -> bool:
        """Whether every holonomy defect is below the tolerance (the budget holds if solved)."""
        tolerance = np.radians(self.problem.options.tolerance_degrees)
        return bool((np.abs(self.holonomy_defects) < tolerance).all())


class Stage:
    """A refined surface with its factors and its last aligned field, kept between solves.

    Parameters
    ----------
    problem : Problem
        Whose places are refined at.
    refinement : Refinement
        Of the problem's surface.
    """

    def __init__(self, problem: Problem, refinement: Refinement) -> None:
        self.problem = problem
        self.refinement = refinement
        self._solvers: dict[bool, IsotropicSolver] = {}
        self._turned: dict[tuple[bool, tuple[Singularity, ...]], IsotropicSolver] = {}
        self._aligned: dict[object, AlignedField] = {}

    def serves(self, problem: Problem) -> bool:
        """Whether the problem has the same places on the same surface."""
        before = self.problem
        return (
            before.surface is problem.surface
            and before.options.refine == problem.options.refine
            and [s.point for s in before.singularities] == [s.point for s in problem.singularities]
            and before.chosen_corners == problem.chosen_corners
            and before.marking == problem.marking
        )

    @cached_property
    def features(self) -> Features:
        """The problem's features on the refined surface."""
        return self.problem.features.refined(self.refinement)

    def solver(self, flips: bool) -> IsotropicSolver:
        """The factored surface, flipped to Delaunay or with its own triangles."""
        if flips not in self._solvers:
            # refinement keeps the numbers of vertices, so the corners stay where they are
            made = IsotropicSolver(
                self.refinement.surface,
                self.problem.chosen_corners,
                flips=flips,
                features=self.features,
            )
            self._solvers[flips] = made
            if made.discretization.delaunay.n_flips == 0:  # the two are the same then
                self._solvers[False] = made
        return self._solvers[flips]

    def solver_for(self, problem: Problem, flips: bool) -> IsotropicSolver:
        """The solver of a problem that is served, turned so that separatrices join where it may."""
        solver, key = self.solver(flips), (flips, self.placed(problem))
        if not solver.may_turn or not problem.singularities:
            return solver
        if key not in self._turned:
            self._turned = {k: s for k, s in self._turned.items() if k[1] == key[1]}
            self._turned[key] = solver.turned(joining_turn(solver.solve(key[1])))
        return self._turned[key]

    def placed(self, problem: Problem) -> tuple[Singularity, ...]:
        """The singularities of a problem that is served, at the vertices made for them."""
        surface, vertices = self.refinement.surface, self.refinement.vertices
        return tuple(
            replace(s, point=surface.point_at_vertex(int(vertex)))
            for s, vertex in zip(problem.singularities, vertices, strict=True)
        )

    def aligned(self, problem: Problem) -> AlignedField:
        """The aligned field of a problem that is served."""
        singularities, turns = self.placed(problem), problem.options.turns
        if (singularities, turns) not in self._aligned:
            solver = self.solver_for(problem, flips=False)
            field = aligned_field(solver, singularities, turns)
            self._aligned = {(singularities, turns): field}
        return self._aligned[singularities, turns]
