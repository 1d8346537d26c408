"""How each method that is not isotropic finds its field, and how the field of each gets its map."""

from __future__ import annotations

from collections.abc import Generator

from crossview.cases.model import Options
from crossview.workflow.release import Solved, with_fewer_features
from solvers.features import Features
from solvers.fields import (
    AlignedField,
    CrossField,
    IntegratedField,
    Limits,
    PreparedSurface,
    aligned_field,
    alternating_field,
    anisotropic_field,
    field_existence,
    holonomy_class,
    judge,
)
from solvers.maps import MappedField, unfolded
from solvers.progress import Progress, between
from solvers.singularities import existence
from solvers.surface import FloatArray

Solving = Generator[Progress, None, Solved]

FIRST = 0.6
"""Part of the progress at which the field that follows all features is found. Chosen."""


def integrate(
    method: str, aligned: AlignedField, options: Options, sizes: FloatArray | None, limits: Limits
) -> Solving:
    """Find the field of a method, from the aligned field, and its map, if it is integrable.

    An anisotropic field whose map is folded gives way to one of another way or, unless the options
    ask for turns, of other turns, where that is not folded. Where a field along features has no
    injective map, features are released until there is one.

    Parameters
    ----------
    method : {"aligned", "anisotropic", "alternating"}
    aligned : AlignedField
    options : Options
    sizes : (n,) or (n, 2) float array, optional
        At the vertices of the surface solved on.
    limits : Limits
        What is integrable.
    """
    if not len(aligned.features):
        return (yield from _integrated(method, aligned, options, sizes, limits))
    found = _integrated(method, aligned, options, sizes, limits)
    first = yield from between(found, 0.0, FIRST)
    if first.injective or not _features_may_be_why(first, method, options):
        return first

    def solve(without: Features) -> Solving:
        fewer = aligned_field(aligned.prepared, options.turns, without=without)
        return _integrated(method, fewer, options, sizes, limits)

    return (yield from between(with_fewer_features(first, solve), FIRST, 1.0))


def isotropic_map(
    prepared: PreparedSurface, field: CrossField, limits: Limits
) -> MappedField | None:
    """Return an isotropic field with its map; None if it is refused before."""
    if judge(field, limits=limits).refused:
        return None
    aligned = aligned_field(prepared, like=field)
    return MappedField.of(IntegratedField(aligned, aligned.start))


def _features_may_be_why(first: Solved, method: str, options: Options) -> bool:
    """Whether a field without injective map could have one if it followed fewer features.

    Not if a theorem forbids it whatever the features, nor if the method does not lead to fields
    that are integrable.
    """
    if first.mapped is None and method != "anisotropic":
        return False
    field = first.integrated.field
    turns = None if options.turns is None else holonomy_class(first.integrated.aligned)
    known = existence(field.surface, field.singularities, field.corners, turns)
    return known.theorem is None


def _integrated(
    method: str, aligned: AlignedField, options: Options, sizes: FloatArray | None, limits: Limits
) -> Solving:
    """Find the field of a method, and its map, as `integrate`, along the features that are."""
    if method == "anisotropic":
        found = yield from anisotropic_field(aligned, sizes)
    elif method == "alternating":
        found = yield from alternating_field(aligned, options.proximal_weight)
    else:
        found = IntegratedField(aligned, aligned.start)
    mapped = with_map(found, limits)
    if mapped is not None and method == "anisotropic":
        mapped = yield from unfolded(mapped, sizes, keep_turns=options.turns is not None)
        found = mapped.integrated
    return Solved(found, mapped)


def with_map(integrated: IntegratedField, limits: Limits) -> MappedField | None:
    """Return a field with its map; None if it is not integrable, or a theorem says it has none."""
    field = integrated.field
    if field.energy > limits.energy:
        return None
    possible = field_existence(integrated.aligned).theorem is None
    return MappedField.of(integrated) if possible else None
