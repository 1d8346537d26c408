"""The seamless map of a field in which separatrices meet the nodes they nearly meet."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array

from solvers.errors import counted
from solvers.fields.aligned import IntegratedField
from solvers.fields.verdict import STRICT
from solvers.layouts.charts import Chart
from solvers.layouts.errors import LayoutError
from solvers.maps.seamless import SeamlessFit
from solvers.remedies import MAKE_VALID
from solvers.surface.triangulation import IntArray
from solvers.surface.trisurface import TriSurface

MOST = 50
"""Separatrices that are joined at once. Chosen: each needs a solve."""

SPOILT = 0.03
"""Distance of a map from what the field asks for, relative, beyond which nothing is joined.

Chosen; measured on annuli of 4 000 to 12 000 triangles, without any join: 0.01 to 0.027.
"""


class JoinedMap:
    """The seamless map of a field while it is joined.

    Parameters
    ----------
    integrated : IntegratedField
        The field.
    fit : SeamlessFit
        Of the field.

    Attributes
    ----------
    chart : Chart
        The map as it is now.
    """

    def __init__(self, integrated: IntegratedField, fit: SeamlessFit) -> None:
        self.integrated = integrated
        self._integrability = integrated.aligned.integrability
        self._fit = fit
        self.chart = self._chart()

    @property
    def surface(self) -> TriSurface:
        """What is mapped."""
        return self.integrated.field.surface

    @property
    def mended(self) -> int:
        """Number of triangles made stiffer."""
        return self._fit.mended

    @property
    def inverted(self) -> IntArray:
        """Inverted triangles."""
        return self._fit.map.inverted

    def join(self, rows: csr_array) -> bool:
        """Fit the map again so that also combinations of images vanish: of the first as many rows
        as do not spoil it. Return whether it was.
        """
        before, rows = self._fit, rows[:MOST]
        kept, count = before.joins.rows.shape[0], rows.shape[0]
        every, most = before.joining(rows), max(SPOILT, 2 * before.map.distance)
        while count:
            some = every.first(kept + count)
            near = before.distance(some) <= most
            if near and (fit := before.joined(some, most)) is not None:
                self._fit = fit
                self.chart = self._chart()
                return True
            count //= 2
        return False

    def _chart(self) -> Chart:
        matching, images = self._fit.matching, self._fit.map.images @ np.array([1, 1j])
        return Chart(matching.working, images, matching.period_jumps)

    def require_upright(self) -> None:
        """Raise `LayoutError` if triangles are inverted or vertices are wound around wrongly."""
        map_ = self._fit.map
        if map_.upright:
            return
        field, t = self.integrated.field, self.chart.triangulation
        if len(map_.inverted):
            fault = f"{counted(len(map_.inverted), 'triangle')} inverted"
            faces = map_.inverted
        else:
            fault = f"{counted(len(map_.wrong_windings), 'vertex')} with the wrong number of quads"
            faces = np.flatnonzero(np.isin(t.faces, map_.wrong_windings).any(axis=1))
        faces = self.chart.on_surface(faces)
        places = field.surface.positions([s.point for s in field.singularities])
        where = ""
        if len(places):
            gaps = np.linalg.norm(field.surface.barycentres[faces][:, None] - places, axis=2)
            near = np.unique(gaps.argmin(axis=1)) + 1
            where = "near " + ", ".join(f"singularity {n}" for n in near[:4])
        bridged = STRICT.missed(self.integrated.aligned.isotropic.defects).any()
        raise LayoutError(
            f"no injective map was found, the best has {fault}",
            where,
            remedies=(MAKE_VALID,) if bridged else (),
            faces=faces,
        )
