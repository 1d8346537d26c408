"""Cases that several tests solve, and the command line in this process."""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import Path

import pytest

from crossview.cli import main
from tests.command_line import CaseFile, Crossview, Placed, Ran


@pytest.fixture
def crossview(capsys: pytest.CaptureFixture[str]) -> Crossview:
    """Run a command line in this process."""

    def run(*arguments: object) -> Ran:
        capsys.readouterr()
        status = main([str(argument) for argument in arguments])
        captured = capsys.readouterr()
        return Ran(status, captured.out, captured.err)

    return run


@pytest.fixture
def case_file(tmp_path: Path) -> CaseFile:
    """Write a case file."""

    def write(surface: object, singularities: Iterable[Placed] = (), **more: object) -> Path:
        placed = [{"position": list(p), "valence": valence} for p, valence in singularities]
        path = tmp_path / "case.json"
        path.write_text(json.dumps({"surface": surface, "singularities": placed, **more}))
        return path

    return write
