"""What layouts are refused with."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from solvers.errors import CrossviewError
from solvers.remedies import Remedy
from solvers.surface.triangulation import IntArray


class LayoutError(CrossviewError):
    """No layout can be made of a field.

    Parameters
    ----------
    what, where, advice : str
        As in `CrossviewError`.
    faces : (k,) int array, optional
        Triangles of the field's surface that are to blame.
    remedies : iterable of Remedy, optional
        As in `CrossviewError`.

    Examples
    --------
    An aligned field that is not integrable has no layout:

    >>> from solvers import run
    >>> from solvers.fields import IntegratedField, aligned_field, prepare
    >>> from solvers.layouts import LayoutError, quad_layout
    >>> from solvers.primitives import annulus
    >>> from solvers.singularities import Singularity
    >>> surface = annulus(n=36)
    >>> three = Singularity(surface.closest_point([0.8, 0.0, 0.0]), 3)
    >>> five = Singularity(surface.closest_point([0.5, 0.3, 0.0]), 5)
    >>> aligned = aligned_field(prepare(surface, [three, five]))
    >>> try:
    ...     run(quad_layout(IntegratedField(aligned, aligned.start)))
    ... except LayoutError as error:
    ...     print([remedy.words for remedy in error.remedies])
    ['make the configuration valid', 'solve the anisotropic field']
    """

    def __init__(
        self,
        what: str,
        where: str = "",
        advice: str = "",
        faces: IntArray | None = None,
        *,
        remedies: Iterable[Remedy] = (),
    ) -> None:
        super().__init__(what, where, advice, remedies=remedies)
        self.faces = np.zeros(0, dtype=np.int64) if faces is None else faces
