"""crossview snap: a case whose separatrices meet."""

import json
import re
from pathlib import Path

from tests.command_line import CaseFile, Crossview

LINE = (
    r"snapped: \d+ connections?, singularities moved by up to \S+, "
    r"(\d+) patches and 0 T-junctions -> (\d+) patches and 0 T-junctions; wrote (.*)\n"
)


def test_a_plate_gets_fewer_patches(
    crossview: Crossview, case_file: CaseFile, tmp_path: Path
) -> None:
    plate = {"builtin": "plate_with_holes", "holes": 1, "edge_length": 0.12}
    full, valid, snapped = (tmp_path / f"{name}.json" for name in ("full", "valid", "snapped"))
    assert crossview("complete", case_file(plate, []), "-o", full).status == 0
    assert crossview("make-valid", full, "-o", valid).status == 0
    ran = crossview("snap", valid, "-o", snapped)
    assert (ran.status, ran.err) == (0, "")
    told = re.fullmatch(LINE, ran.out)
    assert told is not None
    assert int(told[2]) < int(told[1])
    assert told[3] == str(snapped)
    joined = json.loads(snapped.read_text())["connections"]
    assert len(joined) > 1
    for command in ("improve", "make-valid", "snap"):
        after = tmp_path / f"{command}.json"
        assert crossview(command, snapped, "-o", after).status == 0
        assert json.loads(after.read_text())["connections"] == joined


def test_where_nothing_may_move_nothing_is_written(
    crossview: Crossview, case_file: CaseFile, tmp_path: Path
) -> None:
    ran = crossview("snap", case_file({"builtin": "annulus"}, []), "-o", tmp_path / "snapped.json")
    assert ran.status == 2
    assert "no singularity may move: add some" in ran.err
    assert not (tmp_path / "snapped.json").exists()
