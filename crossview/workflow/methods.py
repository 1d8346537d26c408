"""How each method that is not isotropic finds its field, and how its field is judged."""

from __future__ import annotations

from collections.abc import Generator

from crossview.cases.model import Options
from solvers.fields import (
    AlignedField,
    IntegratedField,
    Limits,
    alternating_field,
    anisotropic_field,
    holonomy_class,
)
from solvers.maps import MappedField, unfolded
from solvers.progress import Progress
from solvers.singularities import existence
from solvers.surface import FloatArray


def integrate(
    method: str, aligned: AlignedField, options: Options, sizes: FloatArray | None, limits: Limits
) -> Generator[Progress, None, tuple[IntegratedField, MappedField | None]]:
    """Find the field of a method, from the aligned field, and its map, if it is integrable.

    An anisotropic field whose map is folded gives way to one of another way or, unless the options
    ask for turns, of other turns, where that is not folded.

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
    if method == "anisotropic":
        found = yield from anisotropic_field(aligned, sizes)
    elif method == "alternating":
        found = yield from alternating_field(aligned, options.proximal_weight)
    else:
        found = IntegratedField(aligned, aligned.start)
    mapped = with_map(found, limits)
    if mapped is None or method != "anisotropic":
        return found, mapped
    mapped = yield from unfolded(mapped, sizes, keep_turns=options.turns is not None)
    return mapped.integrated, mapped


def with_map(integrated: IntegratedField, limits: Limits) -> MappedField | None:
    """Return a field with its map; None if it is not integrable, or a theorem says it has none."""
    field = integrated.field
    if field.energy > limits.energy:
        return None
    turns = holonomy_class(integrated.aligned)
    known = existence(field.surface, field.singularities, field.corners, turns)
    return None if known.theorem is not None else MappedField.of(integrated)
