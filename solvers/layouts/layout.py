"""The quad layout of a field: separatrices in its seamless map, and the T-mesh between them."""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import dataclass
from functools import cached_property

from solvers.fields.aligned import IntegratedField
from solvers.fields.pieces import field_existence
from solvers.fields.verdict import Verdict, judge
from solvers.layouts.arrangement import Arrangement
from solvers.layouts.drawing import LONGEST, Drawing
from solvers.layouts.errors import LayoutError
from solvers.layouts.joined_map import JoinedMap
from solvers.layouts.nodes import feature_nodes, singular_nodes
from solvers.layouts.patches import PatchMesh, sampled
from solvers.layouts.separatrices import Separatrices
from solvers.layouts.tmesh import TMesh
from solvers.maps.seamless import SeamlessFit
from solvers.progress import Progress
from solvers.surface.triangulation import FloatArray
from solvers.surface.trisurface import TriSurface

SHORT = 1.5
"""Length of traces, in diameters of the map, while the map is joined. Chosen."""

JOININGS = 4
"""How often the map is fitted again for separatrices to meet nodes they nearly meet. Chosen."""


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
    inverted : int
        Inverted triangles of the map.
    mended : int
        Triangles made stiffer so that they are not.

    Examples
    --------
    A square is one patch, and its map as large as itself:

    >>> from solvers import run
    >>> from solvers.fields import IntegratedField, aligned_field, prepare
    >>> from solvers.layouts import quad_layout
    >>> from solvers.primitives import square
    >>> aligned = aligned_field(prepare(square(n=4)))
    >>> layout = run(quad_layout(IntegratedField(aligned, aligned.start)))
    >>> layout.patches, layout.inverted, round(layout.tmesh.area, 9)
    (1, 0, 1.0)
    """

    integrated: IntegratedField
    arrangement: Arrangement
    separatrices: Separatrices
    inverted: int
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
        """(t, 3) places where a separatrix that would wind on was cut."""
        return self.separatrices.t_junctions

    @cached_property
    def patch_mesh(self) -> PatchMesh:
        """The rectangles, sampled for pictures."""
        return sampled(self.surface, self.arrangement)

    @property
    def conforming(self) -> bool:
        """Whether there is no T-junction."""
        return not len(self.arrangement.t_junctions)


def quad_layout(
    integrated: IntegratedField, verdict: Verdict | None = None, fit: SeamlessFit | None = None
) -> Generator[Progress, None, QuadLayout]:
    """Cut a surface into rectangles along the separatrices of a field.

    Boundaries that no separatrix reaches, and surfaces without any, get further curves.

    Parameters
    ----------
    integrated : IntegratedField
        Aligned with the boundary and integrable. Where nothing fixes the direction of its crosses,
        `joined_field` turns them so that separatrices join.
    verdict : Verdict, optional
        On the field, or on that of the same configuration on other triangles; by default as
        `judge` gives it.
    fit : SeamlessFit, optional
        Of the field, where it is known.

    Returns
    -------
    QuadLayout
        The rectangles; the result of the computation, for `solvers.run`.

    Raises
    ------
    LayoutError
        The verdict refuses it, or its map has inverted triangles.

    Notes
    -----
    A motorcycle graph (Eppstein et al. 2008) of straight lines in the seamless map.

    Examples
    --------
    The smallest layout of a disk: four valences 3, a square in the middle and four patches around.

    >>> from solvers import run
    >>> from solvers.fields import IntegratedField, aligned_field, prepare
    >>> from solvers.layouts import quad_layout
    >>> from solvers.primitives import disk
    >>> from solvers.singularities import Singularity
    >>> surface = disk(edge_length=0.1)
    >>> places = [[0.5, 0, 0], [0, 0.5, 0], [-0.5, 0, 0], [0, -0.5, 0]]
    >>> threes = [Singularity(surface.closest_point(place), 3) for place in places]
    >>> aligned = aligned_field(prepare(surface, threes))
    >>> layout = run(quad_layout(IntegratedField(aligned, aligned.start)))
    >>> layout.patches, layout.conforming
    (5, True)
    """
    if verdict is None:
        verdict = judge(integrated.field, known=field_existence(integrated.aligned))
    if verdict.refused:
        raise LayoutError(verdict.reason.rstrip("."), remedies=verdict.remedies)
    yield Progress("fitting the seamless map", 0.0)
    map_ = JoinedMap(integrated, SeamlessFit(integrated) if fit is None else fit)
    map_.require_upright()  # joining turns no more over
    yield Progress("tracing separatrices", 0.4)
    singular = singular_nodes(map_.chart, integrated.field)
    featured = feature_nodes(map_.chart, integrated.aligned, {n.vertex for n in singular})
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
        len(map_.inverted),
        map_.mended,
    )
