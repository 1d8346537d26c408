"""How far a mesh and a surface are apart: faces, boundaries, features, area."""

from __future__ import annotations

import numpy as np

from crossview.certificate.faces import Faces, Floats
from crossview.certificate.fault import Fault, Measures, at
from crossview.certificate.reference import Reference
from crossview.certificate.samples import Ground, along, area, fans, spread, to_segments

SURFACE_LIMIT = 1.5
"""How far mesh and surface, and their boundaries, may be apart, in mean edges. Chosen: nothing
larger than a face is lost."""

FEATURE_LIMIT = 0.35
"""How far a place of a feature may be from an edge, in mean edges. Chosen: a curve that crosses a
square is up to 0.5 from its edges."""

AREA_LIMIT = 0.03
"""By what part the areas may differ. Chosen."""

STEP, FINE = 0.5, 0.1
"""How far apart places on faces, and on segments, are measured, in mean edges. Chosen."""

MOST = 1_000_000
"""Places on segments; further apart where there would be more. Chosen, for memory: a mesh far too
large for its surface is told so all the same."""


class Distances:
    """Distances between a mesh and what it is checked against.

    Parameters
    ----------
    mesh : Faces
    reference : Reference
    edge : float
        The mean edge, in the unit of length.
    """

    def __init__(self, mesh: Faces, reference: Reference, edge: float) -> None:
        self.measures: Measures = {}
        """In the unit of length; None for what only one of the two has."""
        self.faults: list[Fault] = []
        self._edge = edge
        own, _ = fans(mesh)
        covered = area(own)
        self._faces(own, reference, float(np.sqrt(covered / len(mesh.sizes))))
        self._boundary(mesh.points[mesh.rim], reference.surface.points[reference.surface.rim])
        if reference.features is not None and len(reference.features):
            self._features(mesh.points[mesh.edges], reference.features)
        ratio = self.measures["area_ratio"] = covered / reference.area
        if abs(ratio - 1) > AREA_LIMIT:
            self.faults.append(Fault("area", f"the area is {ratio:.4g} of the surface's"))

    def _faces(self, own: Floats, reference: Reference, own_edge: float) -> None:
        """Between faces and surface, both ways."""
        here = spread(own, STEP * (own_edge or self._edge))
        there = spread(reference.triangles, STEP * self._edge)
        self._note("faces_to_surface", "a face is {} off the surface", here, reference.ground)
        self._note("surface_to_faces", "the surface is {} off the mesh", there, Ground(own))

    def _note(self, name: str, said: str, places: Floats, ground: Ground) -> None:
        gaps = ground.distance(places)
        self._judge(name, "surface", said, places, gaps, SURFACE_LIMIT)

    def _boundary(self, here: Floats, there: Floats) -> None:
        """Between the boundaries (k, 2, 3), both ways."""
        if not len(here) or not len(there):
            if len(here) or len(there):
                self.measures["boundary_to_surface"] = self.measures["surface_to_boundary"] = None
                said = "is lost" if len(there) else "is none of the surface's"
                place = (here if len(here) else there)[0, 0]
                self.faults.append(at("boundary", f"a boundary {said}, the first", place))
            return
        for name, said, a, b in (
            ("boundary_to_surface", "the boundary is {} off that of the surface", here, there),
            (
                "surface_to_boundary",
                "the surface's boundary is {} off that of the mesh",
                there,
                here,
            ),
        ):
            self._segments(name, "boundary", said, a, b, SURFACE_LIMIT)

    def _features(self, edges: Floats, features: Floats) -> None:
        said = "a feature is {} off all edges"
        self._segments("features_to_edges", "features", said, features, edges, FEATURE_LIMIT)

    def _segments(
        self, name: str, kind: str, said: str, a: Floats, b: Floats, limit: float
    ) -> None:
        """From segments (k, 2, 3) to others."""
        longest = max(float(np.linalg.norm(x[:, 1] - x[:, 0], axis=1).sum()) for x in (a, b))
        spacing = max(FINE * self._edge, longest / MOST)
        places, _ = along(a, spacing)
        self._judge(name, kind, said, places, to_segments(places, b, spacing), limit)

    def _judge(
        self, name: str, kind: str, said: str, places: Floats, gaps: Floats, limit: float
    ) -> None:
        """Keep the largest distance; a fault if it is above the limit, in mean edges."""
        worst = int(gaps.argmax())
        self.measures[name] = float(gaps[worst])
        if gaps[worst] > limit * self._edge:
            much = f"{gaps[worst] / self._edge:.3g} edges"
            self.faults.append(at(kind, f"{said.format(much)},", places[worst]))
