"""A case on its surface: the surface read and repaired, what the case places put on it."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from crossview.cases.json_values import CaseError
from crossview.cases.model import (
    METHODS,
    Builtin,
    Case,
    Options,
    PlacedCorner,
    PlacedSingularity,
    Position,
    check_method,
)
from crossview.cases.parts import Polyline
from crossview.workflow.loading import load_surfaces
from crossview.workflow.marking import EdgeTracer, Marking
from solvers.features import Features
from solvers.kind_checks import one_of_kind
from solvers.repair import Repaired
from solvers.singularities import (
    Connections,
    Singularity,
    checked_connections,
    checked_corners,
    checked_singularities,
    default_corners,
)
from solvers.surface import FloatArray, SurfacePoint, TriSurface

REACH = 0.05
"""How far from the surface a position may be, in diagonals of the surface."""


@dataclass(frozen=True, eq=False)
class Problem:
    """What is to be solved.

    Parameters
    ----------
    surface : TriSurface
        As read and repaired, before any refinement.
    singularities : iterable of Singularity, optional
        On `surface`.
    corners : mapping of int to int, optional
        Boundary vertex -> index, quarter turns; None: chosen from the interior angles.
    method : {"isotropic", "aligned", "anisotropic", "alternating"}, optional
        How it is solved.
    options : Options, optional
        What may be tuned.
    notes : tuple of str, optional
        What reading and repairing changed, in plain words.
    marking : Marking, optional
        Which edges of `surface` are features.
    source : str or Builtin, optional
        What `surface` was read from or made by; None: in Python.
    connections : tuple of (int, int), optional
        Numbers of singularities, from 0, that separatrices join: making valid, improving and
        snapping keep them so.
    places : mapping of SurfacePoint to tuple of 3 float, optional
        Positions in space that points of `surface` were found by: a case tells the same ones again,
        to the last digit.

    Raises
    ------
    CrossviewError
        The method is unknown, what is given for singularities is something else, or a corner is
        not on the boundary or no whole number.

    Examples
    --------
    >>> from crossview import Problem, Singularity, primitives
    >>> surface = primitives.disk(edge_length=0.1)
    >>> places = [surface.closest_point([x, y, 0]) for x in (-0.4, 0.4) for y in (-0.4, 0.4)]
    >>> problem = Problem(surface, [Singularity(place, 3) for place in places])
    >>> sum(s.index for s in problem.singularities) == 4 * surface.euler_characteristic
    True
    """

    surface: TriSurface
    singularities: Sequence[Singularity] = ()
    corners: Mapping[int, int] | None = None
    method: str = METHODS[0]
    options: Options = field(default_factory=Options)
    notes: tuple[str, ...] = ()
    marking: Marking = field(default_factory=Marking)
    source: str | Builtin | None = None
    connections: Connections = ()
    places: Mapping[SurfacePoint, Position] = field(default_factory=dict, repr=False)

    def __post_init__(self) -> None:
        check_method(self.method, "method")
        advice = "crossview.read_surface reads one, primitives make one"
        one_of_kind("the surface of a problem", self.surface, TriSurface, advice)
        one_of_kind("the options of a problem", self.options, Options)
        one_of_kind("the marking of a problem", self.marking, Marking)
        object.__setattr__(self, "singularities", checked_singularities(self.singularities))
        joined = checked_connections(self.connections, len(self.singularities))
        object.__setattr__(self, "connections", joined)
        if self.corners is not None:
            object.__setattr__(self, "corners", checked_corners(self.surface, self.corners))

    @classmethod
    def from_case(cls, case: Case) -> Problem:
        """Read the surface of a case and put its singularities and corners on it.

        Parameters
        ----------
        case : Case
            Of one component.

        Returns
        -------
        Problem
            With positions in space taken to the nearest points of the surface.

        Raises
        ------
        CrossviewError
            The surface cannot be read or is none, it has several components and the case chooses
            none of them, or a position is too far from it.
        """
        if case.options.component == "all":
            raise CaseError("all components are chosen, one is wanted", "options.component")
        return problems_of(case)[0]

    @cached_property
    def chosen_corners(self) -> Mapping[int, int]:
        """The corners, the automatic ones if none are given."""
        return default_corners(self.surface) if self.corners is None else self.corners

    @property
    def known_turns(self) -> tuple[int, ...] | None:
        """The turns of its field, known before any solve where it is flat."""
        turning = [s.index for s in self.singularities] + list(self.chosen_corners.values())
        return None if self.method == "isotropic" or any(turning) else self.options.turns

    @cached_property
    def features(self) -> Features:
        """The edges that crosses are to follow."""
        return self.marking.on(self.surface)

    def same_places(self, other: Problem) -> bool:
        """Whether a surface prepared for the other problem serves this one: valences may differ.

        Parameters
        ----------
        other : Problem
            Perhaps of other valences.
        """
        return (
            self.surface is other.surface
            and self.options.refine == other.options.refine
            and [s.point for s in self.singularities] == [s.point for s in other.singularities]
            and self.chosen_corners == other.chosen_corners
            and self.marking == other.marking
        )

    def same_but_method(self, other: Problem) -> bool:
        """Whether the other problem differs from this one in its method at most.

        Parameters
        ----------
        other : Problem
            Perhaps of another method.
        """
        return (
            self.surface is other.surface
            and self.singularities == other.singularities
            and self.chosen_corners == other.chosen_corners
            and self.options == other.options
            and self.marking == other.marking
        )

    def to_case(self, surface: str | Builtin, title: str = "") -> Case:
        """Return the case that describes this problem.

        Parameters
        ----------
        surface : str or Builtin
            What its surface is read from.
        title : str, optional
            One line on what the case shows.
        """
        singularities = tuple(
            PlacedSingularity(self._place(s.point), s.valence, s.locked) for s in self.singularities
        )
        corners = None
        if self.corners is not None:
            corners = tuple(
                PlacedCorner(_triple(self.surface.vertices[vertex]), index)
                for vertex, index in self.corners.items()
            )
        features = self.marking.placed(self.surface)
        return Case(
            surface,
            singularities,
            corners,
            self.method,
            self.options,
            title=title,
            connections=self.connections,
            features=features,
        )

    def _place(self, point: SurfacePoint) -> Position:
        """Where a point is, as the case had it if it did."""
        return self.places.get(point) or _triple(self.surface.position(point))


def problems_of(case: Case) -> tuple[Problem, ...]:
    """The problem of a case, or one for each component if it asks for all.

    Raises
    ------
    CrossviewError
        As `Problem.from_case`.
    """
    return problems_on(case, load_surfaces(case))


def problems_on(case: Case, pieces: Sequence[Repaired]) -> tuple[Problem, ...]:
    """A case on each of the surfaces loaded for it; positions belong to the nearest surface.

    Raises
    ------
    CaseError
        A position is away from all of them.
    """
    surfaces = [piece.surface for piece in pieces]
    singularities: list[list[Singularity]] = [[] for _ in surfaces]
    found: list[dict[SurfacePoint, Position]] = [{} for _ in surfaces]
    placed_on: list[tuple[int, int]] = []  # surface, and number there
    for number, given in enumerate(case.singularities, start=1):
        name = f"singularity #{number}"
        places = [surface.closest_point(given.position) for surface in surfaces]
        gaps = [
            _gap(surface, surface.position(place), given.position)
            for surface, place in zip(surfaces, places, strict=True)
        ]
        nearest = _within_reach(gaps, name, given.position)
        placed_on.append((nearest, len(singularities[nearest])))
        singularities[nearest].append(Singularity(places[nearest], given.valence, given.locked))
        found[nearest][places[nearest]] = given.position
    connections = _connections(case, placed_on)
    corners = _corners(case, surfaces)
    markings = _markings(case, surfaces)
    return tuple(
        Problem(
            piece.surface,
            tuple(placed),
            cornered,
            case.method,
            case.options,
            piece.notes,
            marking,
            case.surface,
            tuple(connections[number]),
            positions,
        )
        for number, (piece, placed, cornered, marking, positions) in enumerate(
            zip(pieces, singularities, corners, markings, found, strict=True)
        )
    )


def _connections(
    case: Case, placed_on: Sequence[tuple[int, int]]
) -> Mapping[int, list[tuple[int, int]]]:
    """The connections of a case on each surface, whose singularities have numbers of their own."""
    found: dict[int, list[tuple[int, int]]] = defaultdict(list)
    for pair in case.connections:
        (one, first), (other, second) = (placed_on[number] for number in pair)
        if one != other:
            raise CaseError("connected singularities are on different components", str(list(pair)))
        found[one].append((first, second))
    return found


def _corners(case: Case, surfaces: Sequence[TriSurface]) -> Sequence[dict[int, int] | None]:
    """The corners of a case on each surface: at the boundary vertices nearest to them."""
    if case.corners is None:
        return [None] * len(surfaces)
    corners: list[dict[int, int]] = [{} for _ in surfaces]
    for number, given in enumerate(case.corners, start=1):
        name = f"corner #{number}"
        vertices = [_nearest_boundary_vertex(surface, given.position) for surface in surfaces]
        gaps = [
            _gap(surface, surface.vertices[vertex], given.position) if vertex >= 0 else np.inf
            for surface, vertex in zip(surfaces, vertices, strict=True)
        ]
        nearest = _within_reach(gaps, name, given.position)
        vertex = vertices[nearest]
        if vertex in corners[nearest]:
            raise CaseError(f"{name} is at the same boundary vertex as another", str(vertex))
        corners[nearest][vertex] = given.index
    return corners


def _markings(case: Case, surfaces: Sequence[TriSurface]) -> Sequence[Marking]:
    """The features of a case on each surface: a curve belongs to that nearest to its points."""
    given = case.features
    drawings: dict[int, EdgeTracer] = {}
    found: list[dict[str, frozenset[int]]] = [{} for _ in surfaces]
    for key, name, lines in (
        ("marked", "curve", given.curves),
        ("unmarked", "curve without feature", given.without),
    ):
        for number, line in enumerate(lines, start=1):
            gaps = [_curve_gap(surface, line) for surface in surfaces]
            nearest = _within_reach(gaps, f"{name} #{number}", line[0])
            if nearest not in drawings:
                drawings[nearest] = EdgeTracer(surfaces[nearest])
            before = found[nearest].get(key, frozenset())
            found[nearest][key] = before | drawings[nearest].edges([line])
    return [Marking(given.dihedral_degrees, **edges) for edges in found]


def _curve_gap(surface: TriSurface, line: Polyline) -> float:
    """Largest distance of a point of a polyline from the nearest vertex, in diagonals."""
    return (
        max(float(np.linalg.norm(surface.vertices - point, axis=1).min()) for point in line)
        / surface.diagonal
    )


def _nearest_boundary_vertex(surface: TriSurface, position: Position) -> int:
    """The boundary vertex nearest to `position`; -1 on a closed surface."""
    boundary = np.flatnonzero(surface.boundary_vertices)
    if not boundary.size:
        return -1
    gaps = np.linalg.norm(surface.vertices[boundary] - position, axis=1)
    return int(boundary[gaps.argmin()])


def _gap(surface: TriSurface, place: FloatArray, position: Position) -> float:
    """Distance between two places in diagonals of the surface."""
    return float(np.linalg.norm(place - position) / surface.diagonal)


def _within_reach(gaps: Sequence[float], name: str, position: Position) -> int:
    """The least of `gaps`; raises CaseError if even that one is more than `REACH`."""
    nearest = int(np.argmin(gaps))
    if gaps[nearest] <= REACH:
        return nearest
    where = "at " + ", ".join(f"{coordinate:g}" for coordinate in position)
    if not np.isfinite(gaps[nearest]):
        raise CaseError(f"{name} is on a surface without boundary", where, "remove it")
    raise CaseError(
        f"{name} is {100 * gaps[nearest]:.3g} % of the surface's size away from where it may be",
        where,
        f"give a position within {100 * REACH:g} %",
    )


def _triple(position: FloatArray) -> Position:
    x, y, z = (float(coordinate) for coordinate in position)
    return x, y, z
