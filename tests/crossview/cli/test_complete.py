"""crossview complete: the indices that are missing, placed."""

import json
from pathlib import Path

import numpy as np
import pytest

from tests.command_line import CaseFile, Crossview
from tests.real_surfaces import PATHS, REAL


def test_a_bare_surface_is_completed_and_solved(crossview: Crossview, tmp_path: Path) -> None:
    new = tmp_path / "sphere.json"
    ran = crossview("complete", "sphere", "-o", new)
    assert (ran.status, ran.err) == (0, "")
    assert ran.out == f"added 8 of valence 3; wrote {new}\n"
    report = crossview("solve", new, "-o", tmp_path / "out", "--json").json
    assert report["index_sum"] == 8
    assert report["isotropically_valid"]


def test_what_is_there_stays_and_an_annulus_is_made_valid_after(
    crossview: Crossview, case_file: CaseFile, tmp_path: Path
) -> None:
    case = case_file({"builtin": "annulus"}, [((0.7, 0, 0), 6)])
    new, valid = tmp_path / "new.json", tmp_path / "valid.json"
    assert crossview("complete", case, "-o", new).status == 0
    placed = json.loads(new.read_text())["singularities"]
    assert [s["valence"] for s in placed] == [6, 3, 3]
    np.testing.assert_allclose(placed[0]["position"], [0.7, 0, 0], atol=1e-9)
    assert crossview("make-valid", new, "-o", valid, "--quiet").status == 0
    report = crossview("solve", valid, "-o", tmp_path / "out", "--json").json
    assert report["isotropically_valid"]


def test_a_complete_case_is_written_as_it_is(crossview: Crossview, tmp_path: Path) -> None:
    new = tmp_path / "same.json"
    ran = crossview("complete", "disk-4", "-o", new)
    assert ran.out == f"nothing is missing; wrote {new}\n"
    assert len(json.loads(new.read_text())["singularities"]) == 4


SOME = ("plate_holes.stl", "wingnut.obj", "skull_low_resolution.obj", "hand_lowres.obj")


@pytest.mark.parametrize("name", [name for name in SOME if name in REAL])
def test_a_real_surface_is_completed(crossview: Crossview, tmp_path: Path, name: str) -> None:
    new = tmp_path / "new.json"
    ran = crossview("complete", PATHS[name], "-o", new, "--quiet")
    assert (ran.status, ran.err) == (0, "")
    placed = json.loads(new.read_text())["singularities"]
    assert len(placed) == abs(4 * REAL[name].euler_characteristic)
    solved = crossview("solve", new, "-o", tmp_path / "out", "--json")
    assert solved.status == 0, solved.err
