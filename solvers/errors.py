"""The errors a user can meet: one line that says what, where and what to do."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt


class CrossviewError(Exception):
    """A mistake the user can mend, told in one line.

    Parameters
    ----------
    what : str
        What is wrong.
    where : str, optional
        The file, element or setting it is wrong at.
    remedy : str, optional
        What to do about it.
    """

    def __init__(self, what: str, where: str = "", remedy: str = "") -> None:
        self.what = what
        self.where = where
        self.remedy = remedy
        super().__init__(what, where, remedy)

    def __str__(self) -> str:
        """Return ``what (where): remedy`` without line breaks."""
        line = self.what
        if self.where:
            line += f" ({self.where})"
        if self.remedy:
            line += f": {self.remedy}"
        return " ".join(line.split())


class SurfaceError(CrossviewError):
    """A surface that cannot be worked on.

    Parameters
    ----------
    what, where, remedy : str
        As in `CrossviewError`.
    elements : array_like of int, optional
        Numbers of the offending faces, vertices or edges.
    kind : {"", "faces", "vertices", "edges"}, optional
        What `elements` counts. Edges are given as pairs of vertices, shape (k, 2).
    """

    def __init__(
        self,
        what: str,
        where: str = "",
        remedy: str = "",
        elements: npt.ArrayLike = (),
        kind: str = "",
    ) -> None:
        super().__init__(what, where, remedy)
        self.elements: npt.NDArray[np.int64] = np.asarray(elements, dtype=np.int64)
        self.kind = kind


class SingularityError(CrossviewError):
    """A singularity configuration that has no field, or that is placed where none can be."""


class SolveError(CrossviewError):
    """A linear system or an iteration that could not be solved."""
