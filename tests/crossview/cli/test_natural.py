"""crossview natural: from a surface alone to a case that solves."""

import json
from pathlib import Path

from tests.command_line import Crossview


def test_a_surface_gets_natural_singularities_and_solves(
    crossview: Crossview, tmp_path: Path
) -> None:
    new = tmp_path / "natural.json"
    ran = crossview("natural", "disk", "-o", new, "--method", "ginzburg-landau")
    assert (ran.status, ran.err) == (0, "")
    assert ran.out.startswith("4 singularities; wrote ")
    assert [s["valence"] for s in json.loads(new.read_text())["singularities"]] == [3] * 4
    report = crossview("solve", new, "-o", tmp_path / "out", "--json").json
    assert report["isotropically_valid"]


def test_a_torus_needs_none(crossview: Crossview, tmp_path: Path) -> None:
    new = tmp_path / "natural.json"
    ran = crossview("natural", "torus", "-o", new, "--fewest")
    assert (ran.status, ran.err) == (0, "")
    assert ran.out.startswith("0 singularities; wrote ")


def test_an_unknown_method_is_one_line(crossview: Crossview, tmp_path: Path) -> None:
    new = tmp_path / "natural.json"
    ran = crossview("natural", "disk", "-o", new, "--method", "best")
    assert ran.status == 2
    assert ran.err.count("\n") == 1
    assert "one of mbo" in ran.err
    assert not new.exists()
