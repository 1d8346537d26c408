"""The certificate of a mesh: all that was measured, and what is wrong."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from crossview.certificate.angles import SLIVER, Angles, corner_angles
from crossview.certificate.distances import Distances
from crossview.certificate.faces import Faces
from crossview.certificate.fault import Fault, Measures, first
from crossview.certificate.irregular import by_number, compared, irregular
from crossview.certificate.reference import Reference
from crossview.certificate.samples import area, fans
from crossview.certificate.sizes import compared_sizes
from crossview.certificate.topology import counts, topology, topology_faults
from solvers.errors import CrossviewError

COUNT_LIMIT = 0.1
"""By what part the number of faces may differ from what was wanted. Chosen."""


@dataclass(frozen=True)
class Certificate:
    """What a mesh is worth.

    Parameters
    ----------
    measures : dict
        JSON values; lengths in the surface's unit, angles in degrees.
    faults : tuple of Fault
        What is wrong, the gravest first; none if all is right.

    Examples
    --------
    >>> import numpy as np
    >>> from crossview.certificate import Faces, Reference, certify
    >>> corners = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    >>> surface = Reference(Faces.of_one_size(corners, [[0, 1, 2], [0, 2, 3]]))
    >>> certify(Faces.of_one_size(corners, [[0, 1, 2, 3]]), surface).right
    True
    >>> print(certify(Faces.of_one_size(corners, [[0, 2, 1, 3]]), surface).faults[0])
    1 inverted face with a corner of 180 degrees or more, the first at (0.5, 0.5, 0)
    """

    measures: Measures
    faults: tuple[Fault, ...]

    @property
    def right(self) -> bool:
        """Whether nothing is wrong."""
        return not self.faults

    @property
    def inverted(self) -> int:
        """Number of faces with a corner of 180 degrees or more that nothing excuses."""
        return int(self.measures["corners"]["inverted_faces"])

    def to_json(self) -> Measures:
        """The measures, whether all is right, and the faults."""
        faults = [fault.to_json() for fault in self.faults]
        return {"right": self.right, "faults": faults, **self.measures}


def certify_corners(mesh: Faces, reference: Reference) -> tuple[Measures, list[Fault]]:
    """Check the corners of a mesh alone.

    Parameters
    ----------
    mesh, reference
        As of `certify`.

    Returns
    -------
    dict
        As "corners" among the measures of a certificate.
    list of Fault
    """
    angles = corner_angles(mesh, reference.triangles, reference.ground)
    return _corners(angles), _corner_faults(angles)


def certify(mesh: Faces, reference: Reference) -> Certificate:
    """Check a mesh of polygons; nothing of how it was made is known or asked.

    Parameters
    ----------
    mesh : Faces
        The mesh.
    reference : Reference
        The surface it is to cover, and what else was wanted.

    Raises
    ------
    CrossviewError
        The mesh has no area.
    """
    if not area(fans(mesh)[0]) > 0:
        raise CrossviewError("the mesh has no area")
    edge = float(np.sqrt(reference.area / len(mesh.sizes)))
    corners, corner_faults = certify_corners(mesh, reference)
    distances = Distances(mesh, reference, edge)
    measures: Measures = {
        "counts": counts(mesh),
        "topology": {"mesh": topology(mesh), "surface": topology(reference.surface)},
        "corners": corners,
        "mean_edge": edge,
        "distances": distances.measures,
    }
    faults = [
        *topology_faults(mesh, reference.surface),
        *corner_faults,
        *distances.faults,
    ]
    names = ("irregular", "irregular_on_boundary")
    wanted = (reference.singularities, reference.corners)
    for name, found, given in zip(names, irregular(mesh), wanted, strict=True):
        measures[name] = {"found": by_number(found)}
        if given is not None:
            more, wrong = compared(found, given, edge)
            measures[name] |= {"wanted": by_number(given), **more}
            faults += wrong
    if reference.faces is not None:
        measures["wanted"] = reference.faces
        if abs(len(mesh.sizes) / reference.faces - 1) > COUNT_LIMIT:
            said = f"{len(mesh.sizes)} faces, {reference.faces} were wanted"
            faults.append(Fault("count", said))
    if reference.sizes is not None:
        measures["sizes"] = compared_sizes(mesh, reference.sizes)
    return Certificate(measures, tuple(faults))


def _corners(angles: Angles) -> Measures:
    """Angles and what is inverted."""
    quality = angles.scaled_jacobian
    return {
        "min_degrees": float(angles.degrees.min()),
        "max_degrees": float(angles.degrees.max()),
        "inverted_corners": int(np.count_nonzero(angles.inverted)),
        "inverted_faces": len(np.unique(angles.faces.owner[angles.inverted])),
        "excused_at_valence_2": len(np.unique(angles.faces.corners[angles.excused])),
        "pieces_inside_out": angles.inside_out,
        "slivers": int(np.count_nonzero(angles.slivers)),
        "max_side_ratio": float(1 / max(angles.evenness.min(), 1e-300)),
        "min_scaled_jacobian": float(quality.min()),
        "mean_scaled_jacobian": float(quality.mean()),
    }


def _corner_faults(angles: Angles) -> list[Fault]:
    """Inverted faces, pieces that are inside out, and slivers."""
    inverted = np.unique(angles.faces.owner[angles.inverted])
    said, middles = "with a corner of 180 degrees or more", angles.faces.middles
    faults = [*first("inverted", "inverted face", said, middles[inverted])]
    if angles.inside_out:
        faults.append(Fault("inside out", "the mesh is oriented against the surface"))
    said = f"with a side shorter than {SLIVER:g} of its longest"
    faults += first("slivers", "face", said, middles[angles.slivers])
    return faults
