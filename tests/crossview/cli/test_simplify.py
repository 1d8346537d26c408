"""crossview simplify: a case with fewer singularities."""

import json
from pathlib import Path

from tests.command_line import CaseFile, Crossview


def test_a_torus_gets_fewer_and_stays_valid(crossview: Crossview, tmp_path: Path) -> None:
    natural, fewer = tmp_path / "natural.json", tmp_path / "fewer.json"
    assert crossview("natural", "torus", "-o", natural).status == 0
    ran = crossview("simplify", natural, "-o", fewer, "--to", 4)
    assert (ran.status, ran.err) == (0, "")
    before = len(json.loads(natural.read_text())["singularities"])
    assert before > 4
    assert ran.out == f"{before} -> 4 singularities, valid; wrote {fewer}\n"
    report = crossview("solve", fewer, "-o", tmp_path / "out", "--json").json
    assert report["isotropically_valid"]
    assert sorted(s["valence"] for s in report["singularities"]) == [3, 3, 5, 5]


def test_what_cannot_be_is_one_line(
    crossview: Crossview, case_file: CaseFile, tmp_path: Path
) -> None:
    ran = crossview("simplify", "disk-4", "-o", tmp_path / "fewer.json", "--to", 3)
    assert ran.status == 2
    assert ran.err.count("\n") == 1
    assert "no fewer than 4 singularities can be left, 3 are asked for" in ran.err
    assert not (tmp_path / "fewer.json").exists()
