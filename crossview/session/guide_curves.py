"""The validity guide of the singularity under the mouse: no solve, one look-up a condition."""

from __future__ import annotations

from collections.abc import Generator, Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from crossview.session.live import LiveEdit
from solvers.progress import Progress
from solvers.surface import FloatArray, SurfacePoint
from solvers.validity import Guide


@dataclass(frozen=True, eq=False)
class GuideCurve:
    """A level line of a holonomy potential.

    Parameters
    ----------
    condition : int
        Whose.
    ends : (s, 2, 3) float array
        Both ends of each straight piece.
    strong : bool
        Whether it is to be seen first: where an open condition closes, or one pointed at.
    """

    condition: int
    ends: FloatArray
    strong: bool


class Guidance:
    """Where one singularity of an edit may go.

    Parameters
    ----------
    edit : LiveEdit
        The configuration.
    moving : int
        Which of its singularities.
    placed : bool
        Whether it has a place already; else it is only about to be added.
    """

    def __init__(self, edit: LiveEdit, moving: int, placed: bool = True) -> None:
        self._edit = edit
        self._moving = moving
        self._placed = placed

    def curves(
        self, tolerance: float, condition: int | None
    ) -> Generator[Progress, None, tuple[GuideCurve, ...]]:
        """Return the lines to draw; never yields, so that it is never cut short.

        Of each condition that is open the line on which it closes, of the others the one on which
        they stay closed. Of a single condition, or the one pointed at, also where it stays as is.

        Parameters
        ----------
        tolerance : float
            Largest defect called closed, radians.
        condition : int, optional
            The only one to show.
        """
        yield from ()
        return tuple(self._curves(tolerance, condition))

    def kept(self, condition: int | None, point: SurfacePoint) -> SurfacePoint:
        """Return the point near another on which a condition closes.

        Parameters
        ----------
        condition : int, optional
            Which; by default the one farthest from closed before the singularity was moved.
        point : SurfacePoint
            On the surface of the edit.
        """
        if not len(self._defects):
            return point
        worst = int(np.argmax(np.abs(self._defects)))
        return self._guide.kept(worst if condition is None else condition, point)

    @cached_property
    def _guide(self) -> Guide:
        return Guide(self._edit.base.solver.holonomy, self._edit.singularities, self._moving)

    @cached_property
    def _defects(self) -> FloatArray:
        return self._edit.defects()

    def _curves(self, tolerance: float, condition: int | None) -> Iterator[GuideCurve]:
        surface = self._edit.base.surface
        every = range(len(self._defects))
        shown = every if condition is None else [condition]
        for i in shown:
            closed = self._placed and abs(self._defects[i]) < tolerance
            pointed_at = condition is not None or len(every) == 1
            if self._placed and pointed_at and not closed:
                yield GuideCurve(i, self._guide.keeping(i).ends(surface), strong=False)
            strong = not closed or condition is not None
            yield GuideCurve(i, self._guide.closing(i).ends(surface), strong)
