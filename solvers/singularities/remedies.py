"""What may be done about an index budget that is missed."""

from __future__ import annotations

from dataclasses import dataclass

from solvers.remedies import Remedy


@dataclass(frozen=True)
class AddMissing(Remedy):
    """Add singularities that the index budget lacks.

    Parameters
    ----------
    words : str
        As in `Remedy`.
    valence : int
        Of each.
    count : int
        How many.
    """

    valence: int
    count: int

    @classmethod
    def of(cls, valence: int, count: int) -> AddMissing:
        """Return the remedy, in its usual words."""
        return cls(f"add {'one' if count == 1 else count} valence {valence}", valence, count)

    @property
    def label(self) -> str:
        """What a button says that does it."""
        return f"Add {'one' if self.count == 1 else f'all {self.count}'} valence {self.valence}"


@dataclass(frozen=True)
class ChangeOne(Remedy):
    """Give one singularity the valence that takes up all that is missing.

    Parameters
    ----------
    words : str
        As in `Remedy`.
    number : int
        Which singularity, from 0.
    valence : int
        Its new valence.
    """

    number: int
    valence: int


@dataclass(frozen=True)
class RemoveOne(Remedy):
    """Take one singularity away, whose index is what is too much.

    Parameters
    ----------
    words : str
        As in `Remedy`.
    number : int
        Which singularity, from 0.
    """

    number: int

    @property
    def label(self) -> str:
        """What a button says that does it."""
        return f"Delete #{self.number + 1}"
