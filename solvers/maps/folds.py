"""Another field where the map of the first is folded: on another way, by other turns.

E = 0 has many solutions. Where defects are large the nearest one may stretch so much that triangles
cannot follow it: each is asked to be upright, and closed they make a map that is folded. E does not
tell; the map does. Other quarter turns around a handle or a boundary, or another way from the
isotropic field, often lead to a field that stretches less.
"""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from solvers.fields.aligned import AlignedField, IntegratedField, aligned_field
from solvers.fields.integrable import anisotropic_field
from solvers.fields.pieces import field_existence
from solvers.fields.verdict import EXTREME_ASPECT
from solvers.maps.closed_images import SeamlessMap
from solvers.maps.seamless import SeamlessFit
from solvers.progress import Progress
from solvers.singularities.decision import existence
from solvers.surface.triangulation import QUARTER, FloatArray

NEIGHBOURS = 12
"""Most turns that are tried besides the nearest.

Measured on a surface of genus 2 with two valences 8: of 15 folded fields the first three mend
seven, the next seven three more.
"""

NEAR = 24
"""Most turns of which topology is asked. Chosen: more than a field has to be off by."""

DETOURS = (-1.0, -0.5, 0.5)
"""Parts of the harmonic correction by which other ways lead.

Measured on six folded annuli with one valence 3 and one 5: from -1 four are upright, from -0.5
two, from 0.5 one; the other two are 6 triangles wide.
"""


@dataclass(frozen=True, eq=False)
class MappedField:
    """A field with its seamless map.

    Parameters
    ----------
    integrated : IntegratedField
        The field.
    fit : SeamlessFit
        The map nearest to it, and what further conditions on it need.

    Examples
    --------
    >>> from solvers.fields import IntegratedField, aligned_field, prepare
    >>> from solvers.maps import MappedField
    >>> from solvers.primitives import square
    >>> aligned = aligned_field(prepare(square(n=4)))
    >>> mapped = MappedField.of(IntegratedField(aligned, aligned.start))
    >>> mapped.faults, mapped.folded
    (0, False)
    """

    integrated: IntegratedField
    fit: SeamlessFit

    @classmethod
    def of(cls, integrated: IntegratedField) -> MappedField:
        """Return a field with its map.

        Parameters
        ----------
        integrated : IntegratedField
            The field.
        """
        return cls(integrated, SeamlessFit(integrated))

    @property
    def map(self) -> SeamlessMap:
        """The map nearest to the field."""
        return self.fit.map

    @property
    def faults(self) -> int:
        """Number of inverted triangles and of vertices that the map winds wrongly around."""
        return len(self.map.inverted) + len(self.map.wrong_windings)

    @property
    def folded(self) -> bool:
        """Whether the map has faults that another field may not have.

        Along features they come from these, unless the field is stretched very much.
        """
        stretched = self.integrated.field.max_log_aspect > EXTREME_ASPECT
        return self.faults > 0 and (stretched or not len(self.integrated.aligned.features))


def unfolded(
    first: MappedField, sizes: FloatArray | None = None, *, keep_turns: bool = False
) -> Generator[Progress, None, MappedField]:
    """Look for an anisotropic field whose map is not folded.

    Parameters
    ----------
    first : MappedField
        The anisotropic field by the shortest way.
    sizes : (n,) or (n, 2) float array, optional
        As of `anisotropic_field`.
    keep_turns : bool, optional
        Whether the turns of the first are asked for, and no others are tried.

    Returns
    -------
    MappedField
        The first found that is not folded, else the one with the fewest faults; the one given if
        that is not folded. Its turns are those of ``integrated.aligned``.

    Raises
    ------
    CrossviewError
        As `anisotropic_field`.

    Examples
    --------
    Where nothing is folded, nothing is solved:

    >>> from solvers import run
    >>> from solvers.fields import IntegratedField, aligned_field, prepare
    >>> from solvers.maps import MappedField, unfolded
    >>> from solvers.primitives import square
    >>> aligned = aligned_field(prepare(square(n=4)))
    >>> first = MappedField.of(IntegratedField(aligned, aligned.start))
    >>> run(unfolded(first)) is first
    True
    """
    best, start = first, first.integrated.aligned
    if not first.folded or not start.turns:
        return first
    near = [] if keep_turns else neighbouring_turns(start)[:NEIGHBOURS]
    ways: list[tuple[tuple[int, ...], float | None]] = [(turns, None) for turns in near]
    ways += [(start.turns, detour) for detour in DETOURS]
    least = first.integrated.field.max_log_aspect
    for turns, detour in ways:
        aligned = start
        if turns != start.turns:
            aligned = aligned_field(
                start.prepared, turns, like=start.isotropic, without=start.without
            )
            if field_existence(aligned).theorem is not None:
                continue
        found = yield from anisotropic_field(aligned, sizes, detour=detour)
        aspect = found.field.max_log_aspect
        # A map costs more than its field: by other turns it is made where the field stretches less.
        if not found.convergence.converged or (detour is None and aspect >= least):
            continue
        least = min(least, aspect)
        tried = MappedField.of(found)
        if tried.faults < best.faults:
            best = tried
            if not best.folded:
                break
    return best


def with_possible_turns(first: AlignedField) -> AlignedField:
    """Return an aligned field with the turns nearest to its own that topology does not forbid.

    Parameters
    ----------
    first : AlignedField
        The field by the turns nearest to the isotropic one.

    Returns
    -------
    AlignedField
        The first itself where its turns are possible, or none near by are.

    Examples
    --------
    >>> from solvers.fields import aligned_field, holonomy_class, prepare
    >>> from solvers.maps import with_possible_turns
    >>> from solvers.primitives import torus
    >>> turned = aligned_field(prepare(torus(n=12)), [1, 0])
    >>> holonomy_class(with_possible_turns(turned))
    (0, 0)
    """
    field = first.isotropic
    anyhow = existence(field.surface, field.singularities, field.corners)
    if field_existence(first).theorem is None or anyhow.theorem is not None:
        return first
    for turns in neighbouring_turns(first)[:NEAR]:
        other = aligned_field(first.prepared, turns, like=first.isotropic, without=first.without)
        if field_existence(other).theorem is None:
            return other
    return first


def neighbouring_turns(aligned: AlignedField) -> list[tuple[int, ...]]:
    """Return other turns than those of a field: one or two of them changed by one.

    Parameters
    ----------
    aligned : AlignedField
        The field.

    Returns
    -------
    list of tuple of int
        Those first whose harmonic correction has the least energy, as of
        `Holonomy.aligned_energy`.
    """
    chosen = np.array(aligned.turns, dtype=np.int64)
    steps = [sign * row for row in np.eye(len(chosen), dtype=np.int64) for sign in (1, -1)]
    pairs = [one + other for one, other in combinations(steps, 2) if (one + other).any()]
    if not steps:
        return []
    turns = chosen + np.array([*steps, *pairs], dtype=np.int64)
    missed = QUARTER * turns - aligned.isotropic.defects
    energy = (missed * np.linalg.solve(aligned.solver.holonomy.harmonic_energy, missed.T).T).sum(1)
    return [tuple(turns[i].tolist()) for i in np.argsort(energy, kind="stable")]
