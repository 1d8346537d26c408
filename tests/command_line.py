"""What the tests of commands share: what a command gave back, and how one refuses."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any


@dataclass(frozen=True)
class Ran:
    """What a command gave back."""

    status: int
    out: str
    err: str

    @property
    def json(self) -> Any:
        return json.loads(self.out)


Placed = tuple[Sequence[float], int]
"""A singularity of a case: where it is, and its valence."""

Crossview = Callable[..., Ran]
CaseFile = Callable[..., Path]


def refused(ran: Ran, folder: Path, *said: str) -> None:
    """One line that says all of `said`; status 2; nothing written into the folder."""
    assert ran.err.startswith("crossview: error: ")
    assert ran.err.count("\n") == 1
    for words in said:
        assert words in ran.err
    assert ran.status == 2
    assert ran.out == ""
    assert not (folder / "out").exists()
    assert not list(folder.glob(".crossview-*"))
