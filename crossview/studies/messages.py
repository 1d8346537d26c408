"""What is said between the process that works on cases and its parent, besides parcels."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from crossview.studies.plan import Task


@dataclass(frozen=True)
class MemoryLimit:
    """Bytes of data that the process may hold from now on."""

    bytes: int


@dataclass(frozen=True)
class Job:
    """A case to work on.

    Parameters
    ----------
    task : Task
        The case and its steps.
    home : Path
        Where its files will be kept in the end.
    digests : mapping of str to str
        What each file that it names is known by; all of them have been sent as parcels.
    """

    task: Task
    home: Path
    digests: Mapping[str, str]


@dataclass(frozen=True)
class At:
    """A step is begun; with the first of a job its clock starts."""

    step: str
