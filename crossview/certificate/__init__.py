"""Whether a mesh is what was wanted: a judge that shares nothing with what makes meshes."""

from __future__ import annotations

from crossview.certificate.certificate import Certificate, certify, certify_corners
from crossview.certificate.faces import Faces
from crossview.certificate.fault import Fault
from crossview.certificate.reference import Irregular, Reference, Sizes

__all__ = [
    "Certificate",
    "Faces",
    "Fault",
    "Irregular",
    "Reference",
    "Sizes",
    "certify",
    "certify_corners",
]
