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
    what, where, advice, remedies
        As in `CrossviewError`.
    faces : (k,) int array, optional
        Triangles of the field's surface that are to blame.
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
