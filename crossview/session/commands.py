"""Everything the user can change, as values: a name for the menu and how it maps a document."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Protocol

from crossview.session.document import Document
from crossview.workflow.marking import Marking
from solvers.errors import counted
from solvers.singularities import Connections, Singularity
from solvers.surface import SurfacePoint

METHOD_LABELS = {
    "isotropic": "Isotropic",
    "aligned": "Theta imposed",
    "anisotropic": "Anisotropic",
    "alternating": "Alternating (paper)",
}
"""What the methods are called, in the order of menus."""

MIN_VALENCE = 1
"""The least valence that the window offers: one separatrix."""

MAX_VALENCE = 12
"""The highest that the window offers. Chosen."""


class Command(Protocol):
    """One undoable change; `name` completes "Undo ..." in the menu."""

    @property
    def name(self) -> str:
        """What the change is called, lower case, singularities numbered from 1."""

    def apply(self, document: Document) -> Document:
        """Return the changed document."""


@dataclass(frozen=True)
class AddSingularities:
    """Append singularities; most often one."""

    added: tuple[Singularity, ...]

    @property
    def name(self) -> str:
        """Name of the step."""
        if len(self.added) == 1:
            return f"add valence {self.added[0].valence}"
        return f"add {len(self.added)} singularities"

    def apply(self, document: Document) -> Document:
        """Return the document with them appended."""
        placed = (*document.singularities, *self.added)
        return document.with_singularities(placed, document.connections)


@dataclass(frozen=True)
class MoveSingularity:
    """Put a singularity elsewhere on the surface; a whole drag is one of these."""

    index: int
    point: SurfacePoint

    @property
    def name(self) -> str:
        """Name of the step."""
        return f"move singularity {self.index + 1}"

    def apply(self, document: Document) -> Document:
        """Return the document with it moved."""
        return _with_changed(document, self.index, point=self.point)


@dataclass(frozen=True)
class ChangeValence:
    """Give a singularity another valence."""

    index: int
    valence: int

    @property
    def name(self) -> str:
        """Name of the step."""
        return f"make singularity {self.index + 1} a valence {self.valence}"

    def apply(self, document: Document) -> Document:
        """Return the document with the valence changed, its connections given up."""
        changed = _with_changed(document, self.index, valence=self.valence)
        return GiveUpConnections(frozenset({self.index})).apply(changed)


@dataclass(frozen=True)
class LockSingularity:
    """Keep a singularity where it is, or let it go."""

    index: int
    locked: bool

    @property
    def name(self) -> str:
        """Name of the step."""
        return f"{'lock' if self.locked else 'unlock'} singularity {self.index + 1}"

    def apply(self, document: Document) -> Document:
        """Return the document with the lock changed."""
        return _with_changed(document, self.index, locked=self.locked)


@dataclass(frozen=True)
class Together:
    """Several changes as one step."""

    commands: tuple[Command, ...]
    name: str

    def apply(self, document: Document) -> Document:
        """Return the document after each of them, in order."""
        for command in self.commands:
            document = command.apply(document)
        return document


@dataclass(frozen=True)
class RemoveSingularities:
    """Delete the singularities with these indices."""

    indices: frozenset[int]

    @property
    def name(self) -> str:
        """Name of the step."""
        if len(self.indices) == 1:
            return f"delete singularity {min(self.indices) + 1}"
        return f"delete {len(self.indices)} singularities"

    def apply(self, document: Document) -> Document:
        """Return the document without them."""
        kept = [i for i in range(len(document.singularities)) if i not in self.indices]
        number = {before: after for after, before in enumerate(kept)}
        connections = tuple(
            (number[a], number[b]) for a, b in document.connections if a in number and b in number
        )
        return document.with_singularities([document.singularities[i] for i in kept], connections)


@dataclass(frozen=True)
class GiveUpConnections:
    """Let separatrices that join singularities with these indices part again."""

    indices: frozenset[int]

    @property
    def name(self) -> str:
        """Name of the step."""
        return "let connections go"

    def apply(self, document: Document) -> Document:
        """Return the document without their connections."""
        left = tuple(pair for pair in document.connections if not self.indices & set(pair))
        return document.with_singularities(document.singularities, left)


@dataclass(frozen=True)
class ReplaceSingularities:
    """Put other singularities in place of all there are.

    Parameters
    ----------
    singularities : tuple of Singularity
    name : str
        Name of the step.
    automatic_corners : bool
        Whether the corners become those chosen from the boundary's angles.
    connections : tuple of (int, int)
        Which of them are to stay joined.
    """

    singularities: tuple[Singularity, ...]
    name: str
    automatic_corners: bool = False
    connections: Connections = ()

    def apply(self, document: Document) -> Document:
        """Return the document with these singularities and no others."""
        if self.automatic_corners:
            document = document.with_automatic_corners()
        return document.with_singularities(self.singularities, self.connections)


@dataclass(frozen=True)
class SetCorners:
    """Give corners other indices; those of index 0 are none."""

    changed: tuple[tuple[int, int], ...]

    @property
    def name(self) -> str:
        """Name of the step."""
        return f"change {counted(len(self.changed), 'corner')}"

    def apply(self, document: Document) -> Document:
        """Return the document with them changed."""
        corners = {**document.corners, **dict(self.changed)}
        return document.with_corners({vertex: k for vertex, k in corners.items() if k})


@dataclass(frozen=True)
class AddTurns:
    """Let crosses turn more, or less, over the holonomy conditions."""

    by: tuple[int, ...]

    @property
    def name(self) -> str:
        """Name of the step."""
        return "change the turns"

    def apply(self, document: Document) -> Document:
        """Return the document with these turns added."""
        before = document.problem.options.turns or (0,) * len(self.by)
        return document.with_turns([a + b for a, b in zip(before, self.by, strict=True)])


@dataclass(frozen=True)
class ChooseMethod:
    """Solve by another method."""

    method: str

    @property
    def name(self) -> str:
        """Name of the step."""
        return f"choose method {METHOD_LABELS[self.method].lower()}"

    def apply(self, document: Document) -> Document:
        """Return the document with the method chosen."""
        return replace(document, problem=replace(document.problem, method=self.method))


@dataclass(frozen=True)
class ChangeTitle:
    """Say something else about the configuration."""

    title: str
    name: str = "change the title"

    def apply(self, document: Document) -> Document:
        """Return the document with the title."""
        return document.with_title(self.title)


@dataclass(frozen=True)
class MarkFeatures:
    """Choose other feature edges."""

    marking: Marking
    name: str = "mark features"

    def apply(self, document: Document) -> Document:
        """Return the document with these features."""
        return replace(document, problem=replace(document.problem, marking=self.marking))


def next_valence(valence: int, step: int) -> int:
    """Return the valence one step up or down, skipping the regular 4, within the limits."""
    following = valence + step
    if following == 4:
        following += step
    return following if MIN_VALENCE <= following <= MAX_VALENCE else valence


def _with_changed(document: Document, index: int, **changes: object) -> Document:
    singularities = list(document.singularities)
    singularities[index] = replace(singularities[index], **changes)  # type: ignore[arg-type]
    return document.with_singularities(singularities, document.connections)
