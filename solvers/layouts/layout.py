"""The quad layout of a field: separatrices in its seamless map, and the T-mesh between them."""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from solvers.fields.aligned import IntegratedField
from solvers.layouts.arrangement import Arrangement
from solvers.layouts.drawing import LONGEST, Drawing
from solvers.layouts.errors import LayoutError
from solvers.layouts.joined_map import JoinedMap
from solvers.layouts.nodes import feature_nodes, singular_nodes
from solvers.layouts.patches import PatchMesh, sampled
from solvers.layouts.separatrices import Separatrices
from solvers.layouts.tmesh import TMesh
from solvers.progress import Progress
from solvers.remedies import ANISOTROPIC, MAKE_VALID
from solvers.surface.triangulation import FloatArray
from solvers.surface.trisurface import TriSurface

SHORT = 1.5
"""Length of traces, in diameters, while the map is joined."""

JOININGS = 4
"""How often the map is fitted again so that separatrices meet the nodes they nearly meet."""

MISALIGNED = 1e-4
"""Angle between the cross and the boundary, radians, beyond which there is no layout."""

NOT_INTEGRABLE = 0.01
"""E beyond which there is no layout."""


@dataclass(frozen=True, eq=False)
class QuadLayout:
    """A surface cut into rectangles along the separatrices of its field.

    Parameters
    ----------
    integrated : IntegratedField
        The field.
    arrangement : Arrangement
        The rectangles and where their arcs lie.
    separatrices : Separatrices
        As curves on the surface, seeds included.
    flips : int
        Triangles turned over in the map.
    mended : int
        Triangles made stiffer so that they are not.
    """

    integrated: IntegratedField
    arrangement: Arrangement
    separatrices: Separatrices
    flips: int
    mended: int

    @property
    def surface(self) -> TriSurface:
        """What is cut."""
        return self.separatrices.surface

    @property
    def tmesh(self) -> TMesh:
        """The rectangles."""
        return self.arrangement.tmesh

    @property
    def patches(self) -> int:
        """Number of rectangles."""
        return self.tmesh.n_rectangles

    @property
    def t_junctions(self) -> FloatArray:
        """(t, 3) places where a limit cycle was cut."""
        return self.separatrices.t_junctions

    @property
    def limit_cycles(self) -> int:
        """Number of separatrices that are limit cycles."""
        return self.separatrices.limit_cycles

    @cached_property
    def patch_mesh(self) -> PatchMesh:
        """The rectangles, sampled for pictures."""
        return sampled(self.surface, self.arrangement)

    @property
    def conforming(self) -> bool:
        """Whether there is no T-junction."""
        return self.limit_cycles == 0


def quad_layout(integrated: IntegratedField) -> Generator[Progress, None, QuadLayout]:
    """Cut a surface into rectangles along the separatrices of a field.

    Boundaries that no separatrix reaches, and surfaces without any, get further curves.

    Parameters
    ----------
    integrated : IntegratedField
        Aligned with the boundary and integrable.

    Returns
    -------
    QuadLayout

    Raises
    ------
    LayoutError
        The field is not aligned or not integrable, or its map has triangles turned over.
    """
    _require_integrable(integrated)
    yield Progress("fitting the seamless map", 0.0)
    map_ = JoinedMap(integrated)
    map_.require_upright()  # joining turns no more over
    yield Progress("tracing separatrices", 0.4)
    singular = singular_nodes(map_.chart, integrated.field)
    featured = feature_nodes(map_.chart, map_.features, {n.vertex for n in singular})
    drawing = Drawing(map_, singular, featured, SHORT)
    for _ in range(JOININGS):
        yield Progress("joining separatrices", 0.6)
        if not map_.join(drawing.offsets()):
            break
        drawing = drawing.again()
    yield Progress("cutting into rectangles", 0.8)
    drawing = drawing.again(LONGEST)
    for _ in range(JOININGS):
        if not map_.join(drawing.loose_ends()):
            break
        drawing = drawing.again()
    while (seed := drawing.missing()) is not None:
        drawing = drawing.seeded(*seed)
    return QuadLayout(
        integrated,
        drawing.arrangement(),
        drawing.separatrices(),
        len(map_.flipped),
        map_.mended,
    )


def _require_integrable(integrated: IntegratedField) -> None:
    field = integrated.field
    worst = float(np.abs(field.boundary_misalignment).max(initial=0.0))
    if worst > MISALIGNED:
        raise LayoutError(
            f"the field misses a boundary by {np.degrees(worst):.3g} degrees",
            remedies=(MAKE_VALID, ANISOTROPIC),
        )
    if field.energy > NOT_INTEGRABLE:
        raise LayoutError(
            f"the field is not integrable, E = {field.energy:.2g}",
            remedies=(MAKE_VALID, ANISOTROPIC),
        )
