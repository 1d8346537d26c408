"""crossview improve: a case whose sizes are made more even."""

import re
from pathlib import Path

import numpy as np

from tests.command_line import CaseFile, Crossview

ONE = r"improved: variance of H (\S+) -> (\S+), sizes (\S+) -> (\S+) to 1, "
TWO = r"(\d+) patches and \d+ T-junctions -> (\d+) patches and \d+ T-junctions; wrote (.*)\n"


def test_a_plate_gets_more_even_sizes_and_fewer_patches(
    crossview: Crossview, case_file: CaseFile, tmp_path: Path
) -> None:
    case = case_file({"builtin": "plate_with_holes", "holes": 3, "edge_length": 0.12}, [])
    full, valid, better = (tmp_path / f"{name}.json" for name in ("full", "valid", "better"))
    assert crossview("complete", case, "-o", full).status == 0
    assert crossview("make-valid", full, "-o", valid).status == 0
    ran = crossview("improve", valid, "-o", better)
    assert (ran.status, ran.err) == (0, "")
    told = re.fullmatch(ONE + TWO, ran.out)
    assert told is not None
    before, after, ratio, less = (float(x) for x in told.groups()[:4])
    assert after < 0.5 * before
    assert less < ratio
    assert int(told[6]) <= int(told[5])
    assert told[7] == str(better)
    report = crossview("solve", better, "-o", tmp_path / "out", "--json").json
    assert report["isotropically_valid"]
    assert np.abs(report["boundary_misalignment_degrees"]).max() < 1e-5


def test_without_singularities_that_may_move_nothing_is_written(
    crossview: Crossview, case_file: CaseFile, tmp_path: Path
) -> None:
    case = case_file({"builtin": "annulus"}, [])
    ran = crossview("improve", case, "-o", tmp_path / "better.json")
    assert ran.status == 2
    assert "no singularity may move: add some" in ran.err
    assert not (tmp_path / "better.json").exists()
