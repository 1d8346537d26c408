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
)
from solvers.maps import seamless_map
from solvers.progress import Progress
from solvers.surface import FloatArray

Integration = Generator[Progress, None, IntegratedField]


def integrate(
    method: str, aligned: AlignedField, options: Options, sizes: FloatArray | None
) -> Integration:
    """Find the field of a method, from the aligned field.

    Parameters
    ----------
    method : {"aligned", "anisotropic", "alternating"}
    aligned : AlignedField
    options : Options
    sizes : (n,) or (n, 2) float array, optional
        At the vertices of the surface solved on.
    """
    if method == "anisotropic":
        return (yield from anisotropic_field(aligned, sizes))
    if method == "alternating":
        return (yield from alternating_field(aligned, options.proximal_weight))
    return IntegratedField(aligned, aligned.start)


def map_faults(
    integrated: IntegratedField | None, limits: Limits
) -> tuple[int, int] | tuple[None, None]:
    """How many triangles of a field's map are inverted, how many vertices it winds wrongly around.

    Of both None if the field has no map.
    """
    if integrated is None or integrated.field.energy > limits.energy:
        return None, None
    found = seamless_map(integrated)
    return len(found.inverted), len(found.wrong_windings)
