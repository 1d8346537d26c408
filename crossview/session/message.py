"""The one line over the scene: what is said, why, and what may be done about it."""

from __future__ import annotations

from dataclasses import dataclass

from crossview.session.opening import Opening
from crossview.view.values import Elements
from crossview.workflow.quads import MeshOptions
from solvers.remedies import Remedy
from solvers.surface import FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class ShowWhere(Remedy):
    """Show the file that could not be opened, with the offending elements pointed out.

    Parameters
    ----------
    words : str
        As in `Remedy`.
    elements : Elements
        Numbered as in the file.
    """

    elements: Elements


@dataclass(frozen=True)
class NaturalBy(Remedy):
    """Place natural singularities by another method.

    Parameters
    ----------
    words : str
        As in `Remedy`.
    method : str
        As of `solvers.fields.natural_singularities`.
    """

    method: str


@dataclass(frozen=True, eq=False)
class Faulty:
    """Triangles that are no surface, and what is wrong with them.

    Parameters
    ----------
    vertices : (n, 3) float array
    faces : (m, 3) int array
    elements : Elements
        The offending ones.
    """

    vertices: FloatArray
    faces: IntArray
    elements: Elements


@dataclass(frozen=True, eq=False)
class Message:
    """One line over the scene.

    Parameters
    ----------
    text : str
        What is told.
    cause : str
        What the message is about; it goes when that succeeds ("open", "solve", "edit", ...).
    severity : {"error", "warning", "info"}
    below : str
        Where, and what to do; may be empty.
    details : str
        More to read and copy; may be empty.
    remedies : tuple of Remedy
        What the window can do about it: its buttons.
    tried : Opening, MeshOptions or None
        What was to be opened or made, which a remedy goes on with.
    stopped : bool
        Whether it tells that the user has stopped something.
    faulty : Faulty or None
        What it is about, to be shown in the scene as long as the message stands.
    pointed : Elements or None
        The same, where it is a part of the surface shown.
    """

    text: str
    cause: str
    severity: str = "error"
    below: str = ""
    details: str = ""
    remedies: tuple[Remedy, ...] = ()
    tried: Opening | MeshOptions | None = None
    stopped: bool = False
    faulty: Faulty | None = None
    pointed: Elements | None = None
