"""Quads of which one is inverted are not delivered by solve unless asked for."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.command_line import Crossview, Ran, refused
from tests.inverted import INVERTED


@pytest.fixture
def spoiled(tmp_path: Path) -> Path:
    path = tmp_path / "l.json"
    path.write_text(json.dumps(INVERTED))
    return path


def told(ran: Ran) -> str:
    """The one line on what is inverted."""
    assert ran.status == 1
    assert ran.err.count("\n") == 1
    assert "1 inverted face with a corner of 180 degrees or more, the first at (" in ran.err
    return ran.err


def names(folder: Path) -> set[str]:
    return {path.name for path in folder.iterdir()}


def test_inverted_quads_are_not_delivered_and_nothing_else_is_lost(
    crossview: Crossview, tmp_path: Path, spoiled: Path
) -> None:
    options = ["-o", tmp_path / "out", "--quads", "--target-quads", "200"]
    ran = crossview("solve", spoiled, *options)
    assert "no quads are written" in told(ran)
    assert "--allow-inverted" in ran.err
    assert "1 inverted face" in ran.out
    assert {"report.json", "surface.vtp", "crosses.vtp", "layout.vtp"} <= names(tmp_path / "out")
    assert not {name for name in names(tmp_path / "out") if name.startswith("quads")}
    report = json.loads((tmp_path / "out" / "report.json").read_text())
    assert report["quads"]["inverted"] == 1
    assert not report["quads"]["delivered"]


def test_inverted_quads_that_are_asked_for_are_told(
    crossview: Crossview, tmp_path: Path, spoiled: Path
) -> None:
    options = ["-o", tmp_path / "out", "--quads", "--target-quads", "200", "--allow-inverted"]
    ran = crossview("solve", spoiled, *options)
    assert "written as allowed" in told(ran)
    assert "1 inverted face" in ran.out
    assert {"quads.vtk", "quads.obj"} <= names(tmp_path / "out")
    report = json.loads((tmp_path / "out" / "report.json").read_text())
    assert report["quads"]["delivered"]
    assert not report["quads"]["certificate"]["right"]


def test_allowing_inverted_quads_is_about_quads(crossview: Crossview, tmp_path: Path) -> None:
    ran = crossview("solve", "disk-4", "-o", tmp_path / "out", "--allow-inverted")
    refused(ran, tmp_path, "--allow-inverted is about quads", "add --quads")
