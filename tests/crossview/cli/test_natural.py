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


def test_singularities_that_the_triangles_place_are_told(
    crossview: Crossview, tmp_path: Path
) -> None:
    new = tmp_path / "natural.json"
    ran = crossview("natural", "disk", "-o", new, "--method", "globally-optimal")
    assert (ran.status, ran.err) == (0, "")
    assert ran.out.startswith("4 singularities, 4 of them as near to another as edges are long")


def test_a_torus_needs_none(crossview: Crossview, tmp_path: Path) -> None:
    new = tmp_path / "natural.json"
    ran = crossview("natural", "torus", "-o", new, "--fewest")
    assert (ran.status, ran.err) == (0, "")
    assert ran.out.startswith("0 singularities; wrote ")


def test_so_many_at_most_or_one_line(crossview: Crossview, tmp_path: Path) -> None:
    new = tmp_path / "natural.json"
    ran = crossview("natural", "torus", "-o", new, "--most", "6", "--scale", "0.01")
    assert (ran.status, ran.err) == (0, "")
    assert 0 < len(json.loads(new.read_text())["singularities"]) <= 6
    ran = crossview("natural", "disk", "-o", tmp_path / "none.json", "--most", "3")
    assert ran.status == 2
    assert ran.err.count("\n") == 1
    assert "no fewer than 4 singularities can be left" in ran.err
    assert not (tmp_path / "none.json").exists()


def test_an_unknown_method_is_one_line(crossview: Crossview, tmp_path: Path) -> None:
    new = tmp_path / "natural.json"
    ran = crossview("natural", "disk", "-o", new, "--method", "best")
    assert ran.status == 2
    assert ran.err.count("\n") == 1
    assert "one of mbo" in ran.err
    assert not new.exists()
