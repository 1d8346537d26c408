"""Studies: what is planned, what is told of a case, what stays through failures and kills."""

import csv
import json
import signal
import subprocess
import sys
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import crossview as library
from crossview.studies.ledger import LINES
from crossview.studies.plan import Refusal, plan
from crossview.studies.study import Study
from tests.command_line import Crossview, refused
from tests.inverted import INVERTED

ANNULUS = {
    "surface": {"builtin": "annulus", "n": 48},
    "singularities": [
        {"position": [0.8, 0, 0], "valence": 3},
        {"position": [0.6, 0, 0], "valence": 5},
    ],
}
DISK = {
    "surface": {"builtin": "disk", "edge_length": 0.2},
    "singularities": [{"position": [0, 0, 0], "valence": 3}],
}


def lines(folder: Path) -> list[dict[str, Any]]:
    return [json.loads(line) for line in (folder / LINES).read_text().splitlines()]


def test_a_sweep_finds_the_defect_that_theory_tells(tmp_path: Path) -> None:
    """Turned by phi against the valence 3, a valence 5 misses the inner circle by phi / 4."""
    angles = np.radians([20, 50, 80, 110])
    places = [[0.6 * np.cos(a), 0.6 * np.sin(a), 0.0] for a in angles]
    study = {"cases": [ANNULUS], "vary": {"singularities[1].position": places}}
    rows = library.batch(study, tmp_path, workers=2)
    assert [row["status"] for row in rows] == ["done"] * 4
    assert [row["singularities[1].position"] for row in rows] == places
    defects = [abs(row["holonomy.defect_degrees.max"]) for row in rows]
    # the circles are polygons of 48 sides
    assert defects == pytest.approx(np.degrees(angles) / 4, rel=1e-3)


def test_inverted_quads_are_kept_only_when_that_is_allowed(tmp_path: Path) -> None:
    quads = {"target_quads": 200}
    study = {
        "cases": [INVERTED],
        "vary": {"quads.allow_inverted": [False, True]},
        "steps": ["solve", {"quads": quads}],
        "files": ["obj"],
    }
    refusal, kept = library.batch(study, tmp_path, workers=1)
    assert (refusal["status"], refusal["step"]) == ("failed", "writing")
    assert refusal["reason"].startswith("not written: 1 inverted face with a corner")
    assert (refusal["quads.inverted"], refusal["quads.delivered"]) == (1, False)
    assert (kept["status"], kept["quads.delivered"]) == ("done", True)
    assert [path.name for path in tmp_path.rglob("*.obj")] == ["quads.obj"]


def test_the_table_has_what_the_report_has(crossview: Crossview, tmp_path: Path) -> None:
    study = tmp_path / "study.json"
    study.write_text(
        json.dumps(
            {
                "cases": ["disk-4"],
                "vary": {"quads.target_quads": [100, 300], "singularities[0].valence": [3, 4]},
                "steps": ["solve", "quads"],
                "figures": ["quads.*", "index_*"],
                "files": ["case", "report", "obj"],
            }
        )
    )
    ran = crossview("batch", study, "-o", tmp_path / "out")
    assert (ran.status, ran.err) == (0, "")
    assert ran.out == f"2 done, 2 failed; wrote {tmp_path / 'out'}\n"
    with (tmp_path / "out" / "table.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    for row in rows:
        if row["singularities[0].valence"] == "4":
            assert "index budget" in row["reason"]
            assert (row["status"], row["step"], row["files"]) == ("failed", "solve", "")
            continue
        kept = tmp_path / "out" / row["files"]
        report = json.loads((kept / "report.json").read_text())
        assert int(row["quads.quads"]) == report["quads"]["quads"]
        assert float(row["quads.min_scaled_jacobian"]) == report["quads"]["min_scaled_jacobian"]
        assert (kept / "quads.obj").read_text().count("\nf ") == report["quads"]["quads"]
        solved = library.report(library.solve(library.read(kept / "case.json")))
        assert solved["index_sum"] == int(row["index_sum"])
        assert not any(name.startswith(("surface", "layout")) for name in row)
    page = (tmp_path / "out" / "index.html").read_text()
    assert "2 done, 2 failed" in page
    assert "miss the index budget" in page


def test_random_draws_are_of_the_seed_the_place_and_the_sample_alone() -> None:
    def drawn(**more: Any) -> list[list[Any]]:
        data = {"cases": [DISK], "samples": 5, "seed": 3, **more}
        data["vary"] = {"singularities[0].position": "anywhere", **data.get("vary", {})}
        return [list(task.varied["singularities[0].position"]) for task in plan(study(data))]

    def study(data: dict[str, Any]) -> Study:
        return Study.from_json(data)

    first = drawn()
    assert drawn() == first
    assert drawn(seed=4) != first
    assert len({tuple(place) for place in first}) == 5
    assert drawn(vary={"options.refine": {"least": 0, "most": 3, "whole": True}}) == first
    paired = drawn(vary={"method": ["isotropic", "aligned"]})
    assert paired[::2] == paired[1::2] == first


def test_points_anywhere_are_spread_by_area() -> None:
    """Within a radius r of a disk lies the share r^2 of its area."""
    data = {"cases": [DISK], "samples": 400, "vary": {"singularities[0].position": "anywhere"}}
    places = [task.varied["singularities[0].position"] for task in plan(Study.from_json(data))]
    radii = np.linalg.norm(places, axis=1)
    shares = [np.mean(radii < r) for r in (0.3, 0.5, 0.7, 0.9)]
    # three standard deviations of a share of 400, and 4 % that the polygon is smaller than the disk
    assert shares == pytest.approx([0.09, 0.25, 0.49, 0.81], abs=3 * 0.5 / 20 + 0.04)


def test_what_cannot_be_read_is_a_row(tmp_path: Path) -> None:
    library.write_case(library.read("disk-4"), tmp_path / "good.json")
    (tmp_path / "bad.json").write_text("{")
    rows = library.batch({"cases": [str(tmp_path / "*.json")]}, tmp_path / "out", workers=1)
    assert [row["status"] for row in rows] == ["refused", "done"]
    assert "malformed JSON" in rows[0]["reason"]


def test_a_limit_ends_a_case_and_a_wider_one_lets_it_run_again(tmp_path: Path) -> None:
    study = {"cases": ["sphere"], "steps": ["natural", "solve"], "vary": {"natural.seed": [0, 1]}}
    rows = library.batch(study, tmp_path, workers=2, time_limit=0.02)
    assert {row["status"] for row in rows} == {"timed out"}
    assert {row["reason"] for row in rows} == {"not done after 0.02 s"}
    library.batch(study, tmp_path, workers=2, time_limit=0.01)
    assert len(lines(tmp_path)) == 2
    rows = library.batch(study, tmp_path, workers=2)
    assert {row["status"] for row in rows} == {"done"}
    assert {row["singularities.count"] for row in rows} == {8}


def test_a_case_too_large_for_the_memory_limit_harms_no_other(tmp_path: Path) -> None:
    large = {"surface": {"builtin": "sphere", "subdivisions": 7}}
    rows = library.batch(
        {"cases": [large, DISK], "steps": ["natural", "solve"]},
        tmp_path,
        workers=1,
        memory_limit=0.6,
        time_limit=60,
    )
    assert rows[0]["status"] in ("out of memory", "died")
    assert "memory" in rows[0]["reason"].lower()
    assert rows[1]["status"] == "done", rows[1]["reason"]


def test_a_killed_study_goes_on_where_it_was(tmp_path: Path) -> None:
    """Nothing is lost, nothing is done twice, and a line cut short is done again."""
    study, out = tmp_path / "study.json", tmp_path / "out"
    angles = np.linspace(0.1, 1, 12)
    places = [[0.6 * np.cos(a), 0.6 * np.sin(a), 0] for a in angles]
    vary = {"singularities[1].position": places}
    study.write_text(json.dumps({"cases": [ANNULUS], "vary": vary}))
    program = "import sys; from crossview.cli import main; main(sys.argv[1:])"
    command = [sys.executable, "-c", program, "batch", study, "-o", out, "--workers", "1"]
    out.mkdir()
    with subprocess.Popen([str(word) for word in command], stdout=subprocess.DEVNULL) as running:
        while running.poll() is None and not (
            (out / LINES).exists() and len((out / LINES).read_bytes().splitlines()) >= 3
        ):
            pass
        running.send_signal(signal.SIGKILL)
    before = (out / LINES).read_bytes()
    whole = before[: before.rfind(b"\n") + 1]
    assert 3 <= whole.count(b"\n") < 12
    (out / LINES).write_bytes(whole + b'{"key": "cut sho')
    rows = library.batch(study, out, workers=2)
    assert (out / LINES).read_bytes().startswith(whole)
    assert set(Counter(line["key"] for line in lines(out)).values()) == {1}
    assert len(lines(out)) == len(rows) == 12
    assert {row["status"] for row in rows} == {"done"}


def test_a_case_is_known_by_the_contents_of_its_files(tmp_path: Path) -> None:
    surface, out = tmp_path / "square.obj", tmp_path / "out"
    corners = ["v 0 0 0", "v 1 0 0", "v 1 1 0", "v 0 1 0", "f 1 2 3 4"]
    surface.write_text("\n".join(corners))
    first = library.batch({"cases": [str(surface)]}, out, workers=1)
    surface.rename(tmp_path / "moved.obj")
    library.batch({"cases": [str(tmp_path / "moved.obj")]}, out, workers=1)
    assert len(lines(out)) == 2  # the file's name is part of what it is known by
    surface.write_text("\n".join(corners).replace("v 1", "v 2"))
    second = library.batch({"cases": [str(surface)]}, out, workers=1)
    assert len(lines(out)) == 3
    assert first[0]["status"] == second[0]["status"] == "done"


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"cases": ["disk-4"], "steps": ["solv"]}, 'unknown step "solv"'),
        ({"cases": ["disk-4"], "steps": ["solve", "natural"]}, "comes after"),
        ({"cases": ["disk-4"], "steps": ["quads"]}, 'needs "solve" before it'),
        ({"cases": ["disk-4"], "steps": [{"quads": {"size": 3}}]}, 'unknown key "size"'),
        ({"cases": ["no-such/*.stl"]}, "no file fits the pattern"),
        ({"cases": ["disk-5"]}, 'did you mean "disk-4"?'),
        ({"cases": ["disk-4"], "vary": {"singularities[9].valence": [3]}}, "has no place"),
        ({"cases": ["disk-4"], "vary": {"singularities[0].valency": [3]}}, 'unknown key "valency"'),
        ({"cases": ["disk-4"], "vary": {"quads.size": [3]}}, 'no step "quads"'),
        ({"cases": ["disk-4"], "vary": {"method": {"least": 2, "most": 1}}}, "below the least"),
        ({"cases": ["disk-4"], "vary": {"method": 3}}, "expected a list of values"),
        ({"cases": ["disk-4"], "samples": 3}, "nothing is drawn at random"),
        ({"cases": []}, "expected a list of 1 or more cases"),
        ({"cases": ["disk-4"], "files": ["stl"]}, "unknown files"),
        ({"case": "disk-4"}, 'did you mean "cases"?'),
    ],
)
def test_a_wrong_study_is_refused(
    crossview: Crossview, tmp_path: Path, wrong: dict[str, Any], said: str
) -> None:
    study = tmp_path / "study.json"
    study.write_text(json.dumps(wrong))
    refused(crossview("batch", study, "-o", tmp_path / "out"), tmp_path, said)


def test_two_batches_do_not_share_a_folder(crossview: Crossview, tmp_path: Path) -> None:
    from crossview.studies.ledger import ledger

    study = tmp_path / "study.json"
    study.write_text(json.dumps({"cases": ["disk-4"]}))
    with ledger(tmp_path / "busy"):
        ran = crossview("batch", study, "-o", tmp_path / "busy")
    assert (ran.status, ran.err.count("\n")) == (2, 1)
    assert "another batch is at work in this folder" in ran.err


def test_a_refusal_tells_what_was_varied() -> None:
    data = {"cases": [DISK], "vary": {"singularities[0].valence": [3, 0]}}
    good, bad = plan(Study.from_json(data))
    assert isinstance(bad, Refusal)
    assert not isinstance(good, Refusal)
    assert bad.varied == {"singularities[0].valence": 0}
    assert "whole number from 1" in bad.reason
