"""What the scene is asked to show: frozen values, no VTK."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import Any, Literal, get_args

from crossview.cases.compounds import Either, ListOf
from crossview.cases.records import documented, key
from crossview.cases.scalars import Flag, Number, Word
from crossview.view.colors import COLOR_MAPS
from crossview.view.geometry import Triangles
from crossview.view.values import (
    Elements,
    FloatArray,
    GuideLine,
    IntArray,
    Marker,
    Measurement,
    Plane,
    Polylines,
    Quads,
)
from solvers.errors import CrossviewError

Background = Literal["white", "dark"]
Coloring = Literal["quality", "patch", "plain"]


_RANGE = Either((Word({"fit": None}), ListOf(Number(), length=2)))
"""Limits of colours, or that they are fitted."""

_SHARE, _FACTOR = Number(least=0, most=1), Number(above=0)
"""How an opacity and a factor are given."""


@documented
@dataclass(frozen=True)
class LayerSettings:
    """How one layer is drawn; `LAYERS` says which of these a layer listens to."""

    visible: bool = field(
        default=True, metadata=key(Flag(), "Whether the layer is drawn.", always=True)
    )
    opacity: float = field(
        default=1.0,
        metadata=key(
            _SHARE,
            "0: nothing. For scalars: how much of their colour covers the grey surface.",
        ),
    )
    color_map: str = field(
        default="",
        metadata=key(
            Word({"": "", **{name: name for name in COLOR_MAPS}}),
            "A name of `COLOR_MAPS`; empty for the layer's own.",
        ),
    )
    value_range: tuple[float, float] | None = field(
        default=None,
        metadata=key(_RANGE, "Colour limits, of the error density powers of 10."),
    )
    size: float = field(
        default=1.0,
        metadata=key(
            _FACTOR, "Factor on the automatic size of the glyphs, or on the width of the lines."
        ),
    )
    density: float = field(
        default=1.0, metadata=key(_FACTOR, "Factor on the automatic number of glyphs.")
    )
    uniform: bool = field(
        default=False, metadata=key(Flag(), "Whether glyphs have one size instead of exp(H).")
    )
    edges: bool = field(
        default=False,
        metadata=key(
            Flag(),
            "Whether edges are drawn: of triangles, of quads, of a layout those between patches.",
            always=True,
        ),
    )
    coloring: Coloring = field(
        default="quality",
        metadata=key(
            Word({name: name for name in get_args(Coloring)}),
            "What the colours of quads mean: scaled Jacobian, patch, nothing.",
        ),
    )
    shaded: bool = field(
        default=False,
        metadata=key(
            Flag(),
            "Whether a scalar's colours are lit, which shows shape; else each is that of the bar.",
        ),
    )


@dataclass(frozen=True)
class LayerKind:
    """A layer's name (as on the command line), its label, what it shows, and what it listens to."""

    name: str
    label: str
    tip: str
    settings: tuple[str, ...] = ()
    visible: bool = True
    edges: bool = False

    def defaults(self, visible: bool) -> LayerSettings:
        """Return the settings it starts with."""
        return LayerSettings(visible=visible, edges=self.edges)


_COLORED = ("opacity", "color_map", "shaded", "value_range")
"""Settings of a scalar."""

LAYERS: tuple[LayerKind, ...] = (
    LayerKind("surface", "Surface", "The triangles", ("opacity", "edges")),
    LayerKind("H", "H", "Logarithm of the size of quads, of two sizes the mean", _COLORED),
    LayerKind(
        "theta", "Theta", "Angle of the crosses against a fixed direction",
        ("opacity", "color_map", "shaded"), visible=False,
    ),
    LayerKind("H1", "H1", "Logarithm of the size along u", _COLORED, visible=False),
    LayerKind("H2", "H2", "Logarithm of the size along v", _COLORED, visible=False),
    LayerKind("aspect", "Aspect", "How far apart both sizes are", _COLORED, visible=False),
    LayerKind(
        "error", "Error density", "Where the field fails to be integrable", _COLORED, visible=False
    ),
    LayerKind(
        "crosses", "Crosses", "Directions of the field, in their sizes",
        ("opacity", "size", "density", "uniform"),
    ),
    LayerKind(
        "separatrices", "Separatrices", "Curves along the crosses that leave singularities",
        ("opacity", "size"),
    ),
    LayerKind(
        "marks", "T and ! marks",
        "T: a separatrix ends at the side of another; !: a boundary that the field is off",
        ("size",),
    ),
    LayerKind(
        "layout", "Layout", "The rectangles that separatrices cut the surface into",
        ("opacity", "edges", "size"), visible=False, edges=True,
    ),
    LayerKind(
        "quads", "Quads", "The quad mesh, in place of the triangles",
        ("coloring", "edges", "size", "shaded", "value_range"), visible=False, edges=True,
    ),
    LayerKind(
        "guide", "Validity guide",
        "Where the singularity under the mouse may go; dotted: what separatrices nearly meet",
        ("size",),
    ),
    LayerKind("singularities", "Singularities", "Discs in the colours of valences", ("size",)),
    LayerKind(
        "cut", "Cut graph", "Edges that, cut, open the surface to a disk", ("opacity", "size"),
        visible=False,
    ),
    LayerKind("features", "Features", "Edges that the crosses are to follow", ("size",)),
    LayerKind("boundary", "Boundary", "Edges of the surface", ("size",)),
    LayerKind("legend", "Legend", "Colours of valences, below the surface"),
    LayerKind("axes", "Axes", "Directions x, y, z, at the upper right"),
)  # fmt: skip
"""What can be shown or not, in the order in which it is listed."""


def default_layers() -> Mapping[str, LayerSettings]:
    """Return the settings every layer starts with, by layer name."""
    return MappingProxyType({kind.name: kind.defaults(kind.visible) for kind in LAYERS})


def layers_named(names: Sequence[str]) -> Mapping[str, LayerSettings]:
    """Return the default settings with only the layers of these names visible.

    Raises
    ------
    CrossviewError
        A name that no layer has.
    """
    known = [kind.name for kind in LAYERS]
    for name in names:
        if name not in known:
            raise CrossviewError(f'no layer "{name}"', "layers", "choose from " + ", ".join(known))
    return MappingProxyType({kind.name: kind.defaults(kind.name in names) for kind in LAYERS})


@dataclass(frozen=True, eq=False)
class SceneView:
    """Everything the scene shows, as one value. What is None or empty is not drawn.

    Arrays are compared by identity: never change one in place, make a new one.

    Parameters
    ----------
    points : (n, 3) float, optional
        Vertices of the surface; need not form a valid `TriSurface`.
    faces : (m, 3) int, optional
        Its triangles.
    triangles : Triangles, optional
        The same, where they have been prepared; made of them by default.
    H : (n,) float, optional
        Log of the size at the vertices, of two sizes the mean.
    half_log_aspect : (m, 3) float, optional
        (H2 - H1) / 2 at the corners of each face; None for one size.
    error_density : (m,) float, optional
        Square of the integrability error, by area.
    u, v : (m, 3) float, optional
        Unit directions of the cross at the faces' barycentres.
    singularities : tuple of Marker
        The singularities placed.
    preview : Marker, optional
        The dot that the add tool carries.
    cut_graph : (k, 2) int, optional
        Vertex pairs.
    features : (k, 2) int, optional
        Vertex pairs of edges that crosses are to follow.
    missed : (k, 2) int, optional
        Those of them on curves that the crosses do not follow.
    loop : (k,) int, optional
        Vertices of a path to point out (a holonomy condition's).
    loop_color : str
        Empty for its own.
    guide : tuple of GuideLine
        Where the singularity under the mouse may go.
    near_misses : Polylines, optional
        From singularities along separatrices to those that they nearly meet.
    measurement : Measurement, optional
    problem : Elements, optional
        Offending elements to point out.
    separatrices : Polylines, optional
    t_junctions : (k, 3) float, optional
        Where a curve is cut: a "T" each.
    misaligned : (k, 3) float, optional
        On boundaries that the field is not aligned with: a "!" each.
    worst : (k, 3) float, optional
        At quads to look at: a "!" each, where quads are drawn.
    layout : Quads, optional
        The patches, finely sampled.
    quads : Quads, optional
        The quad mesh.
    clip : Plane, optional
        What is before it is cut away.
    title : str
        One line at the top left.
    background : {"white", "dark"}
    transparent : bool
        Whether a picture leaves the background out; all is drawn as on it.
    layers : mapping of str to LayerSettings
        As `default_layers`; a layer that is missing is drawn with its defaults.
    """

    points: FloatArray | None = None
    faces: IntArray | None = None
    triangles: Triangles | None = None
    H: FloatArray | None = None
    half_log_aspect: FloatArray | None = None
    error_density: FloatArray | None = None
    u: FloatArray | None = None
    v: FloatArray | None = None
    singularities: tuple[Marker, ...] = ()
    preview: Marker | None = None
    cut_graph: IntArray | None = None
    features: IntArray | None = None
    missed: IntArray | None = None
    loop: IntArray | None = None
    loop_color: str = ""
    guide: tuple[GuideLine, ...] = ()
    near_misses: Polylines | None = None
    measurement: Measurement | None = None
    problem: Elements | None = None
    separatrices: Polylines | None = None
    t_junctions: FloatArray | None = None
    misaligned: FloatArray | None = None
    worst: FloatArray | None = None
    layout: Quads | None = None
    quads: Quads | None = None
    clip: Plane | None = None
    title: str = ""
    background: Background = "white"
    transparent: bool = False
    layers: Mapping[str, LayerSettings] = field(default_factory=default_layers)

    @property
    def cover(self) -> str:
        """What is drawn in place of the triangles, their scalar and (of quads) the crosses."""
        for name, mesh in (("quads", self.quads), ("layout", self.layout)):
            if mesh is not None and len(mesh.quads) and self.layer(name).visible:
                return name
        return ""

    def layer(self, name: str) -> LayerSettings:
        """Return the settings of a layer."""
        return self.layers.get(name) or default_layers()[name]

    def with_layer(self, name: str, **changes: Any) -> SceneView:
        """Return this view with some settings of one layer changed."""
        layers = {**self.layers, name: replace(self.layer(name), **changes)}
        return replace(self, layers=MappingProxyType(layers))
