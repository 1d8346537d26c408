"""crossview make-valid: from a case that is off to one that is not."""

import json
from pathlib import Path

import numpy as np

from tests.command_line import CaseFile, Crossview


def test_a_gallery_case_far_from_valid_is_made_valid(crossview: Crossview, tmp_path: Path) -> None:
    new = tmp_path / "valid.json"
    ran = crossview("make-valid", "annulus-far", "-o", new)
    assert (ran.status, ran.err) == (0, "")
    assert ran.out.startswith("valid: singularities moved by up to ")
    solved = crossview("solve", new, "-o", tmp_path / "out", "--json", "--method", "isotropic")
    report = solved.json
    assert report["isotropically_valid"]
    assert max(abs(c["defect_degrees"]) for c in report["holonomy"]) < 1e-5
    assert np.abs(report["boundary_misalignment_degrees"]).max() < 1e-5
    valences = sorted(s["valence"] for s in json.loads(new.read_text())["singularities"])
    assert valences == [3, 3, 3, 3, 5, 5, 5, 5]


def test_the_impossible_torus_is_refused_and_nothing_written(
    crossview: Crossview, tmp_path: Path
) -> None:
    new = tmp_path / "valid.json"
    ran = crossview("make-valid", "torus-35", "-o", new)
    assert ran.status == 2
    assert "never valid" in ran.err
    assert ran.err.count("\n") == 1
    assert not new.exists()


def test_a_missed_budget_is_told_with_its_remedy(
    crossview: Crossview, case_file: CaseFile, tmp_path: Path
) -> None:
    case = case_file({"builtin": "annulus"}, [((0.7, 0, 0), 3)])
    ran = crossview("make-valid", case, "-o", tmp_path / "valid.json")
    assert ran.status == 2
    assert "index budget, 1 of 0: add one valence 5" in ran.err
