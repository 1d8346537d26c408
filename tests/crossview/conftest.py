"""Cases that several tests solve, and the command line in this process."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from crossview.cli import main


@dataclass(frozen=True)
class Ran:
    """What a command gave back."""

    status: int
    out: str
    err: str

    @property
    def json(self) -> Any:
        return json.loads(self.out)


@pytest.fixture
def crossview(capsys) -> Callable[..., Ran]:
    """Run a command line in this process."""

    def run(*arguments: object) -> Ran:
        capsys.readouterr()
        status = main([str(argument) for argument in arguments])
        captured = capsys.readouterr()
        return Ran(status, captured.out, captured.err)

    return run


@pytest.fixture
def case_file(tmp_path) -> Callable[..., Path]:
    """Write a case file."""

    def write(surface: object, singularities: object = (), **more: object) -> Path:
        placed = [{"position": list(p), "valence": valence} for p, valence in singularities]
        path = tmp_path / "case.json"
        path.write_text(json.dumps({"surface": surface, "singularities": placed, **more}))
        return path

    return write
