"""From a quad layout to its quad mesh."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Generator, Iterable, Sequence
from dataclasses import dataclass, replace
from operator import itemgetter

import numpy as np

from crossview.cases.model import PlacedSingularity
from crossview.certificate import Reference
from crossview.workflow.certification import Worth, own_surface, worth
from crossview.workflow.layout import layout
from crossview.workflow.solution import Solution
from solvers.errors import CrossviewError, SolveError
from solvers.layouts import QuadLayout
from solvers.number_checks import real_number, whole_number
from solvers.progress import Progress, between
from solvers.quads import (
    MAX_CHORD,
    MAX_SIZE_RATIO,
    MOST_QUADS,
    Condition,
    QuadMesh,
    Quantization,
    bending_conditions,
    bent_spacing,
    fewest_quads,
    fill,
    quantize_to,
    size_conditions,
    smoothing_stages,
)
from solvers.singularities import Singularity, SplitOne
from solvers.surface import IntArray, TriSurface


@dataclass(frozen=True)
class _Trial:
    """What is tried: a share of the wanted number, edges that bend little, arcs that may vanish.

    And how many inverted quads at most there may be before, for it to be worth the time.
    """

    share: float = 1.0
    bend_little: bool = False
    may_vanish: bool = True
    most: int = 7


Judged = tuple[Worth, QuadMesh]
"""A mesh, and what it is worth."""

TRIALS = (
    _Trial(),
    _Trial(bend_little=True, most=99),
    *(_Trial(share) for share in (0.97, 1.03, 0.95, 1.05)),
    _Trial(may_vanish=False),
)
"""What is tried one after the other until no quad is inverted.

Chosen: such numbers still meet the wanted one, and where arcs vanish singularities come together.
Measured: edges that bend little mended 19 inverted quads, other numbers never more than 7.
"""

LITTLE = np.radians(45.0)
"""By how much, radians, edges that bend little turn. Chosen."""

DEFAULT_QUADS = 5_000
"""Number of quads that are made if nothing else is said. Chosen."""


@dataclass(frozen=True)
class MeshOptions:
    """How fine the quads are, and what else is done to them.

    Parameters
    ----------
    edge_length : float, optional
        Mean length of their edges: the surface's area is divided by its square.
    target_quads : int, optional
        About how many; 5 000 if neither is given.
    smooth : bool
        Whether vertices slide along the surface to better quads.
    max_chord : float
        Largest distance of an edge from the boundary or feature that it follows, in radii of its
        bend; at most 1.
    max_size_ratio : float
        How much longer than the mean edge of all those along an arc of the layout may be, on
        average, as far as the number of quads allows; above 1.

    Raises
    ------
    CrossviewError
        Both are given, or a number is out of its range.
    """

    edge_length: float | None = None
    target_quads: int | None = None
    smooth: bool = True
    max_chord: float = MAX_CHORD
    max_size_ratio: float = MAX_SIZE_RATIO

    def __post_init__(self) -> None:
        if self.edge_length is not None and self.target_quads is not None:
            raise CrossviewError(
                "both an edge length and a number of quads are wanted", "", "give one of them"
            )
        if self.edge_length is not None:
            real_number("the edge length", self.edge_length, above=0)
        if self.target_quads is not None:
            quads = whole_number("the number of quads", self.target_quads, 1)
            object.__setattr__(self, "target_quads", quads)
        real_number("the chord error", self.max_chord, above=0, most=1)
        real_number("the size ratio", self.max_size_ratio, above=1)

    def number_on(self, surface: TriSurface) -> int:
        """About how many quads these options make on a surface.

        Raises
        ------
        CrossviewError
            Too many, or edges longer than the surface.
        """
        if self.edge_length is None:
            number = float(self.target_quads or DEFAULT_QUADS)
        elif self.edge_length > surface.diagonal:
            raise CrossviewError(
                "the edge length is larger than the surface",
                f"{self.edge_length:g} on a surface of {surface.diagonal:.3g}",
                "give a smaller one",
            )
        else:
            number = surface.area / self.edge_length / self.edge_length  # no square underflows
        if number > MOST_QUADS:
            asked = "" if self.edge_length is None else f"edge length {self.edge_length:g}"
            raise CrossviewError(
                f"{number:.2g} quads are too many", asked, f"at most {MOST_QUADS:,} are made"
            )
        return max(1, round(number))


def quads(layout: QuadLayout, options: MeshOptions) -> Generator[Progress, None, QuadMesh]:
    """Fill a layout with quads; with a few more or less where some would be inverted.

    Parameters
    ----------
    layout : QuadLayout
    options : MeshOptions

    Raises
    ------
    CrossviewError
        The options do not fit the surface, a singularity has valence 1, or no numbers of quads were
        found.
    """
    number = options.number_on(layout.surface)
    require_closing(layout.integrated.field.singularities)
    bends = bending_conditions(layout, options.max_chord)
    each = [Condition(np.array([arc]), 1) for arc in range(layout.tmesh.n_arcs)]
    surface = own_surface(layout.surface)
    tried: list[Judged] = []
    first: Worth | None = None
    filled: list[IntArray] = []
    for k, trial in enumerate(TRIALS):
        best = max(tried, key=itemgetter(0), default=None)
        if best is not None and not (options.smooth and 0 < -best[0].fewest <= trial.most):
            continue
        conditions = bends if trial.may_vanish else bends + each
        turn = LITTLE if trial.bend_little else None
        done = k / len(TRIALS)
        yield Progress("choosing numbers of quads", done)
        share = max(1, round(trial.share * number))
        chosen = _quantized(layout, options, share, conditions, turn)
        if any(np.array_equal(chosen.counts, counts) for counts in filled):
            continue
        filled.append(chosen.counts)
        chosen = replace(chosen, n_wanted=number)
        making = _filled(layout, options, chosen, surface, first)
        made = yield from between(making, done, (k + 1) / len(TRIALS))
        first = made[0][0] if first is None else max(first, made[0][0])
        tried += made
    mesh = max(tried, key=itemgetter(0))[1]
    mesh.check()
    return mesh


def fewest(layout: QuadLayout) -> int | None:
    """Return about the least number of quads that a layout can have, its bends followed.

    Parameters
    ----------
    layout : QuadLayout

    Returns
    -------
    int or None
        None if no numbers of quads were found.
    """
    with contextlib.suppress(SolveError):
        conditions = bending_conditions(layout, MAX_CHORD)
        return fewest_quads(layout.tmesh, conditions=conditions).n_quads
    return None


def _filled(
    layout: QuadLayout,
    options: MeshOptions,
    chosen: Quantization,
    surface: Reference,
    beaten: Worth | None,
) -> Generator[Progress, None, list[Judged]]:
    """Fill a layout with so many quads along its arcs; the stages of smoothing them.

    Only the first if it does not beat what is given.
    """
    yield Progress("filling the patches", 0.3)
    spacing = bent_spacing(layout, chosen.counts, options.max_chord)
    made = replace(fill(layout, chosen.counts, spacing), quantization=chosen)
    if not options.smooth:
        return [(worth(made, surface), made)]
    yield Progress("smoothing", 0.5)
    judged: list[Judged] = []
    curves = [curve.vertices for curve in layout.integrated.aligned.features.curves]
    for smoothed in smoothing_stages(made, curves=curves):
        yield Progress("checking the quads", 0.7 + 0.1 * len(judged))
        judged.append((worth(smoothed, surface), smoothed))
        if beaten is not None and judged[0][0] <= beaten:
            break
    return judged


def _quantized(
    layout: QuadLayout,
    options: MeshOptions,
    number: int,
    conditions: Sequence[Condition],
    turn: float | None,
) -> Quantization:
    """Return numbers of edges, none of which is too long, or turns much, unless that needs more."""
    mean = np.sqrt(layout.surface.area / number)
    sizes = size_conditions(layout, options.max_size_ratio * mean, turn)
    even = quantize_to(layout.tmesh, number, conditions=[*conditions, *sizes])
    return quantize_to(layout.tmesh, number, conditions=conditions) if even.missed else even


def quads_of(
    solution: Solution, options: MeshOptions
) -> Generator[Progress, None, tuple[Solution, QuadLayout, QuadMesh]]:
    """Make the layout and the quads of a solution.

    Parameters
    ----------
    solution : Solution
    options : MeshOptions

    Returns
    -------
    Solution
        The same, with the seconds of the two stages.
    QuadLayout
    QuadMesh

    Raises
    ------
    CrossviewError
        As `layout` and `quads`; what is wrong with the options or with a valence is told
        before anything is made.
    """
    options.number_on(solution.surface)
    require_closing(solution.field.singularities)
    start = time.perf_counter()
    made = yield from between(layout(solution), 0.0, 0.5)
    middle = time.perf_counter()
    filled = yield from between(quads(made, options), 0.5, 1.0)
    seconds = {"layout": middle - start, "quads": time.perf_counter() - middle}
    return replace(solution, seconds={**solution.seconds, **seconds}), made, filled


def require_closing(singularities: Iterable[Singularity | PlacedSingularity]) -> None:
    """Refuse a valence 1: both sides of its quad would be one edge.

    Parameters
    ----------
    singularities : iterable of Singularity or PlacedSingularity

    Raises
    ------
    CrossviewError
        There is one.
    """
    lone = [i for i, s in enumerate(singularities) if s.valence == 1]
    if lone:
        numbers = ", ".join(str(i + 1) for i in lone)
        raise CrossviewError(
            "no quad closes around a valence 1",
            f"singularity {numbers}",
            "take valence 2 or more there",
            remedies=(SplitOne(f"split #{lone[0] + 1} into a 2 and a 3", lone[0]),),
        )
