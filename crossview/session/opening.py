"""From a path, a gallery case or a built-in surface to a document, as a job."""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import dataclass, replace
from pathlib import Path

from crossview.cases.gallery import find_case
from crossview.io import read_surface
from crossview.session.document import Document
from crossview.view.meshes import triangles_of
from solvers.progress import Progress
from solvers.repair import share_vertices
from solvers.surface import FloatArray, IntArray


@dataclass(frozen=True)
class Opening:
    """What is to be opened, and how.

    Parameters
    ----------
    target : str
        A case file, a surface file, or the name of a gallery case or built-in surface.
    component : str or None
        Which piece to take of a surface in several; None leaves it to the case.
    repair : bool
        Also cut the surface apart at non-manifold edges and vertices.
    restores : str or None
        Of a copy of unsaved work: what that was opened from.
    """

    target: str
    component: str | None = None
    repair: bool = False
    restores: str | None = None

    @property
    def source(self) -> str:
        """What the user would name."""
        return self.target if self.restores is None else self.restores


def open_target(opening: Opening) -> Generator[Progress, None, Document]:
    """Read what `opening` names."""
    target = opening.target
    path = Path(target)
    yield Progress(f"reading {path.name}", 0.1)
    case = find_case(target)
    options = case.options
    options = replace(
        options,
        component=opening.component or options.component,
        repair=opening.repair or options.repair,
    )
    case = replace(case, options=options)
    yield Progress("preparing the surface", 0.5)
    document = Document.from_case(path.stem if path.exists() else target, case)
    yield Progress("measuring the surface", 0.9)
    # cached by the surface: what the window's panels show needs no work of the GUI thread
    surface = document.surface
    _ = surface.triangle_quality, surface.genus, surface.boundary_loops, surface.area
    triangles_of(surface)
    return document


def read_triangles(target: str) -> Generator[Progress, None, tuple[FloatArray, IntArray]]:
    """Read the triangles of a file that is no surface, numbered as its error numbers them.

    Returns
    -------
    (n, 3) float array, (m, 3) int array
        Vertices and triangles.
    """
    yield Progress(f"reading {Path(target).name}", 0.1)
    raw = read_surface(str(find_case(target).surface))
    vertices, faces, _ = share_vertices(raw.vertices, raw.faces, merge=raw.merge)
    return vertices, faces
