"""The command line: bad input is one line and leaves nothing behind, good input is scriptable."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import pyvista as pv

from solvers.primitives import sphere, square, torus
from tests.command_line import CaseFile, Crossview, Ran, refused

PROGRAM = Path(sys.executable).with_name("crossview")


def run(*arguments: object, **environment: str) -> subprocess.CompletedProcess[str]:
    """The real entry point in a process of its own, by default without a display."""
    without = {"DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM"}
    clean = {k: v for k, v in os.environ.items() if k not in without}
    return subprocess.run(
        [PROGRAM, *map(str, arguments)],
        capture_output=True,
        text=True,
        timeout=120,
        env=clean | environment,
    )


def write_obj(
    path: Path, vertices: Iterable[Sequence[float]], faces: Iterable[Sequence[int]]
) -> Path:
    rows = ["v {} {} {}".format(*v) for v in vertices]
    rows += ["f {} {} {}".format(*(np.array(f) + 1)) for f in faces]
    path.write_text("\n".join(rows) + "\n")
    return path


@pytest.fixture
def two_pieces(tmp_path: Path) -> Path:
    """A torus and, far from it, a smaller sphere."""
    first, second = torus(n=24), sphere(2)
    vertices = np.concatenate([first.vertices, second.vertices + [10, 0, 0]])
    faces = np.concatenate([first.faces, second.faces + first.n_vertices])
    return write_obj(tmp_path / "two.obj", vertices, faces)


@pytest.mark.parametrize(
    ("case", "said"),
    [
        ({"surface": "none.obj"}, ["no such file", "none.obj"]),
        ({"surface": "torus", "metod": "x"}, ['unknown key "metod"', 'did you mean "method"?']),
        ({"surface": "torus", "method": "algned"}, ['unknown method "algned"', 'mean "aligned"?']),
        ({"surface": {"builtin": "torus", "n": -1}}, ["n must be", "(built-in torus)"]),
        ({"surface": {"builtin": "torus", "n": "many"}}, ["n must be", "'many'"]),
        ({"surface": {"builtin": "planar", "holes": 3}}, ["holes must be a list"]),
        (
            {"surface": "torus", "singularities": [{"position": [1, 0, 0], "valence": 0}]},
            ["expected a whole number from 1 to 100, found 0", "singularities[0].valence"],
        ),
        (
            {"surface": "torus", "singularities": [{"position": [1, 0, float("nan")]}]},
            ['the key "valence" is missing', "singularities[0]"],
        ),
        (
            {
                "surface": "torus",
                "singularities": [
                    {"position": [1.4, 0, 0], "valence": 3},
                    {"position": [3, 0, 0], "valence": 5},
                ],
            },
            ["singularity #2", "39.6 %", "at 3, 0, 0", "within 5 %"],
        ),
        (
            {"surface": "sphere"},
            ["miss the index budget, 0 of 8", "add 8 valence 3 (crossview complete)"],
        ),
        ({"surface": "torus", "options": {"component": 7}}, ["no component 7", "built-in torus"]),
        ({"surface": {"builtin": "sphere", "radius": 1e200}}, ["radius must be a positive number"]),
        ({"surface": {"builtin": "sphere", "subdivisions": True}}, ["must be a whole number"]),
        (
            {"surface": "square", "singularities": [{"position": [0.5, 0, 0], "valence": 4}]},
            ["singularity 1 lies on the boundary", "move it inside"],
        ),
        (
            {
                "surface": "torus",
                "singularities": [
                    {"position": [1.4, 0, 0], "valence": 3},
                    {"position": [1.4, 0, 0], "valence": 5},
                ],
            },
            ["singularities 1 and 2", "move one of them away"],
        ),
        (
            {"surface": "torus", "corners": [{"position": [1.4, 0, 0], "index": 1}]},
            ["corner #1 is on a surface without boundary", "remove it"],
        ),
        (
            {"surface": "square", "corners": [{"position": [0, 0, 0], "index": 1}]},
            ["corner #1", "35.4 %", "within 5 %"],
        ),
        (
            {
                "surface": "square",
                "corners": [{"position": [0.5, 0.5, z], "index": 1} for z in (0, 0.01)],
            },
            ["corner #2 is at the same boundary vertex as another"],
        ),
    ],
)
def test_a_wrong_case_is_refused(
    crossview: Crossview, tmp_path: Path, case: dict[str, Any], said: list[str]
) -> None:
    (tmp_path / "case.json").write_text(json.dumps(case))
    refused(crossview("solve", tmp_path / "case.json", "-o", tmp_path / "out"), tmp_path, *said)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["solve", "torus"], ["--output", "see crossview solve --help"]),
        (["solve", "torus", "-o", "out", "--metod", "x"], ["--metod", "solve --help"]),
        (["slove", "torus"], ['unknown command "slove"', 'did you mean "solve"?']),
        (["--nope"], ["--nope", "see crossview --help"]),
        (["torrus"], ["no such file", 'did you mean "torus"?']),
        (["missing.obj"], ["no such file (missing.obj)"]),
        (["solve", "missing.json", "-o", "out"], ["No such file", "missing.json"]),
        (["solve", "torus", "-o", "out", "--method", "newton"], ["newton", "known: aligned, alt"]),
        (["solve", "torus", "-o", "out", "--component", "big"], ['"big"', '"largest", "all" or']),
        (["solve", "torus", "-o", "file/out"], ["cannot write, Not a directory", "file/out"]),
        (["solve", "torus", "-o", "file"], ["cannot write, Not a directory", "file"]),
        (["info", "picture.png"], ["picture.png"]),
        (["info", "."], ["."]),
        (["render", "torus", "-o", "out/a.xyz"], ["unknown kind of figure (out/a.xyz)"]),
        (["render", "torus", "-o", "."], ["unknown kind of figure (.)"]),
        (["render", "torus", "-o", "out/a.png", "--layers", "G"], ['no layer "G"']),
        (["render", "torus", "-o", "out/a.png", "--size", "big"], ['unknown size "big"']),
        (["render", "torus", "-o", "out/a.png", "--size", "1x1"], ["cannot draw"]),
        (["render", "torus", "-o", "out/a.png", "--scale", "x"], ["--scale", "render --help"]),
        (["render", "torus", "-o", "out/a.png", "--scale", "nan"], ["cannot draw nan x nan"]),
        (["render", "torus", "-o", "out/a.png", "--scale", "inf"], ["cannot draw inf x inf"]),
        (["render", "torus", "-o", "a.png", "--camera", "1e300,0,0,0,0,0,0,0,1"], ["no camera"]),
        (["render", "torus", "-o", "out/a.png", "--camera", "up"], ['no camera "up"']),
        (["render", "torus", "-o", "out/a.png", "--component", "all"], ["--component"]),
        (["gallery", "none", "-o", "out"], ['no gallery case "none"']),
        (["gallery"], ["no folder for the results", "-o"]),
    ],
)
def test_a_wrong_command_line_is_refused(
    crossview: Crossview,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    arguments: list[str],
    said: list[str],
) -> None:
    (tmp_path / "file").write_text("")
    (tmp_path / "picture.png").write_bytes(b"\x89PNG")
    monkeypatch.chdir(tmp_path)
    refused(crossview(*arguments), tmp_path, *said)


def test_what_needs_no_graphics_does_not_wait_for_it() -> None:
    asked = "import sys, crossview.cli; print([m for m in sys.modules if m in sys.argv[1:]])"
    heavy = ["pyvista", "meshio", "vtkmodules", "PySide6", "matplotlib"]
    ran = subprocess.run([sys.executable, "-c", asked, *heavy], capture_output=True, text=True)
    assert ran.stdout == "[]\n"


def test_what_stands_in_the_way_is_told_and_nothing_written(
    crossview: Crossview, tmp_path: Path
) -> None:
    (tmp_path / "there" / "surface.vtp").mkdir(parents=True)
    ran = crossview("solve", "square", "-o", tmp_path / "there")
    refused(ran, tmp_path, "cannot write, surface.vtp is a folder")
    assert [p.name for p in (tmp_path / "there").iterdir()] == ["surface.vtp"]


def test_a_terminal_of_few_letters_and_a_full_disk(tmp_path: Path) -> None:
    path = write_obj(tmp_path / "Würfel.obj", [[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    ran = run("info", path, PYTHONIOENCODING="ascii")
    assert (ran.returncode, ran.stderr) == (0, "")
    assert r"W\xfcrfel.obj: 3 vertices" in ran.stdout
    if not Path("/dev/full").exists():
        return
    with Path("/dev/full").open("w") as full:
        failed = subprocess.run([PROGRAM, "info", path], stdout=full, stderr=-1, text=True)
    assert failed.returncode == 2
    assert failed.stderr == (
        "crossview: error: cannot write the results: No space left on device\n"
    )


def test_a_failed_solve_leaves_earlier_results_alone(crossview: Crossview, tmp_path: Path) -> None:
    assert crossview("solve", "square", "-o", tmp_path / "out").status == 0
    before = {p: p.stat().st_mtime_ns for p in (tmp_path / "out").iterdir()}
    assert crossview("solve", "sphere", "-o", tmp_path / "out").status == 2
    assert {p: p.stat().st_mtime_ns for p in (tmp_path / "out").iterdir()} == before


def test_info_describes_a_surface(crossview: Crossview) -> None:
    found = crossview("info", "annulus", "--json").json
    (piece,) = found["components"]
    assert found["problems"] == []
    assert (piece["euler_characteristic"], piece["genus"], piece["boundary_loops"]) == (0, 0, 2)
    assert piece["boundary_lengths"] == pytest.approx([2 * np.pi, 0.8 * np.pi], rel=1e-3)
    assert piece["area"] == pytest.approx(0.84 * np.pi, rel=1e-2)
    assert piece["index_budget"]["satisfied"]
    text = crossview("info", "annulus").out
    assert "genus 0, 2 boundary loops" in text
    assert "index 0 of 0" in text


def test_info_of_a_case_counts_its_singularities(crossview: Crossview, case_file: CaseFile) -> None:
    path = case_file("sphere", [((0, 0, 1), 1), ((0, 0, -1), 2)])
    (piece,) = crossview("info", path, "--json").json["components"]
    budget = piece["index_budget"]
    assert (budget["index_sum"], budget["required"], budget["missing"]) == (5, 8, 3)
    assert "add 3 valence 3" in budget["remedies"]


def test_info_reports_what_is_wrong_with_a_surface(crossview: Crossview, tmp_path: Path) -> None:
    """Three triangles at one edge, one of them twice: nothing to solve on, but all is named."""
    vertices = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1)]
    faces = [(0, 1, 2), (1, 0, 3), (0, 1, 4), (0, 1, 2)]
    path = write_obj(tmp_path / "bad.obj", vertices, faces)
    found = crossview("info", path, "--json").json
    elements = {p["message"].split(" (")[0]: p["elements"] for p in found["problems"]}
    assert elements["1 duplicate triangle"] == [3]
    assert elements["1 non-manifold edge with more than two triangles"] == [[0, 1]]
    assert found["components"] == []
    assert (found["vertices"], found["faces"]) == (5, 4)
    assert "problem: 1 duplicate triangle" in crossview("info", path).out
    # and the command that would solve on it refuses, but can mend it
    ran = crossview("solve", path, "-o", tmp_path / "out")
    refused(ran, tmp_path, "bad.obj", "non-manifold edge", "(--repair --component largest)")
    assert crossview("info", path, "--repair", "--json").json["components"] != []


def test_info_tells_scripts_whether_a_surface_is_usable(
    crossview: Crossview, two_pieces: Path, tmp_path: Path
) -> None:
    """0: as it is, each of its components; 1: with --repair; 2: not."""
    vertices = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1)]
    doubled = write_obj(tmp_path / "doubled.obj", vertices, [(0, 1, 2), (0, 1, 2), (0, 2, 2)])
    pages = write_obj(tmp_path / "pages.obj", vertices, [(0, 1, 2), (1, 0, 3), (0, 1, 4)])
    flat = write_obj(tmp_path / "flat.obj", [(0, 0, 0), (1, 0, 0), (2, 0, 0)], [(0, 1, 2)])
    nan = write_obj(tmp_path / "nan.obj", [(0, 0, 0), (1, 0, 0), (0, np.nan, 0)], [(0, 1, 2)])
    said = {
        path: crossview("info", path).status for path in (two_pieces, doubled, pages, flat, nan)
    }
    assert list(said.values()) == [0, 0, 1, 2, 2]
    assert crossview("info", pages, "--repair").status == 0
    assert crossview("info", pages, "--json").json["usable"] == "with repair"
    assert "repair" not in crossview("info", doubled).out
    assert crossview("info", "torus").status == 0


def test_messages_hold_no_control_characters_and_are_short(
    crossview: Crossview, tmp_path: Path
) -> None:
    path = tmp_path / "case.json"
    path.write_text(json.dumps({"surface": "torus", "\x1b[31m\x07" + "k" * 5000: 1}))
    said = crossview("info", path).err
    assert said.startswith("crossview: error: ")
    assert said.rstrip("\n").isprintable()
    assert "\\u001b[31m\\u0007kkk" in said
    assert len(said) < 2000


@pytest.mark.parametrize("name", ["surface.obj", "case.txt", "case.json.png"])
def test_a_case_is_written_under_no_other_formats_name(
    crossview: Crossview, tmp_path: Path, name: str
) -> None:
    mesh = sphere(1)
    surface = write_obj(tmp_path / "surface.obj", mesh.vertices, mesh.faces)
    before = surface.read_bytes()
    ran = crossview("complete", surface, "-o", tmp_path / name)
    refused(ran, tmp_path, "cannot write a case under a name without .json")
    assert surface.read_bytes() == before
    assert [path.name for path in tmp_path.iterdir()] == ["surface.obj"]


def test_results_do_not_overwrite_their_own_surface(crossview: Crossview, tmp_path: Path) -> None:
    folder = tmp_path / "mine"
    folder.mkdir()
    mesh = sphere(1)
    pv.PolyData.from_regular_faces(mesh.vertices, mesh.faces).save(folder / "surface.vtp")
    before = (folder / "surface.vtp").read_bytes()
    completed = tmp_path / "case.json"
    assert crossview("complete", folder / "surface.vtp", "-o", completed, "--quiet").status == 0
    refused(crossview("solve", completed, "-o", folder), tmp_path, "overwrite what it is made from")
    assert (folder / "surface.vtp").read_bytes() == before
    assert [path.name for path in folder.iterdir()] == ["surface.vtp"]


@pytest.mark.parametrize("size", [1000, 60_000])
@pytest.mark.parametrize(
    "command", [["solve", "disk-4", "-o", "out"], ["render", "disk-4", "-o", "out.png"]]
)
def test_a_full_disk_is_one_line(tmp_path: Path, command: list[str], size: int) -> None:
    """No file may grow above some bytes."""
    limited = (
        "import resource, sys; "
        f"resource.setrlimit(resource.RLIMIT_FSIZE, ({size}, resource.RLIM_INFINITY)); "
        "from crossview.cli import main; sys.exit(main(sys.argv[1:]))"
    )
    ran = subprocess.run(
        [sys.executable, "-c", limited, *command, "--quiet"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    refused(Ran(ran.returncode, ran.stdout, ran.stderr), tmp_path, "cannot write", "too large")
    assert list(tmp_path.iterdir()) == []


def test_info_lists_all_components(crossview: Crossview, two_pieces: Path) -> None:
    found = crossview("info", two_pieces, "--json").json
    assert [piece["genus"] for piece in found["components"]] == [1, 0]
    assert [piece["index_budget"]["required"] for piece in found["components"]] == [0, 8]
    assert "2 separate components" in found["problems"][0]["message"]
    (piece,) = crossview("info", two_pieces, "--component", "1", "--json").json["components"]
    assert piece["genus"] == 0


def test_a_surface_in_several_components(
    crossview: Crossview, two_pieces: Path, tmp_path: Path, case_file: CaseFile
) -> None:
    out = tmp_path / "out"
    ran = crossview("solve", two_pieces, "-o", out)
    refused(ran, tmp_path, "2 separate components", "largest", "(--component largest)")
    assert crossview("solve", two_pieces, "-o", out, "--component", "largest").status == 0
    report = json.loads((out / "report.json").read_text())
    assert report["surface"]["genus"] == 1
    assert any("kept the largest of 2 components" in note for note in report["notes"])
    # each singularity goes to the component it is on
    poles = [((10, 0, 1), 1), ((10, 0, -1), 1), ((11, 0, 0), 2)]
    case = case_file("two.obj", poles, options={"component": "all"})
    ran = crossview("solve", case, "-o", tmp_path / "all", "--json")
    assert [report["surface"]["genus"] for report in ran.json] == [1, 0]
    assert [len(report["singularities"]) for report in ran.json] == [0, 3]
    for number in (0, 1):
        written = (tmp_path / "all" / f"component-{number}" / "report.json").read_text()
        assert json.loads(written) == ran.json[number]


def test_one_component_of_a_case_of_all_is_drawn(
    crossview: Crossview, two_pieces: Path, tmp_path: Path, case_file: CaseFile
) -> None:
    cube = [((10 + x, y, z), 3) for x in (-0.6, 0.6) for y in (-0.6, 0.6) for z in (-0.6, 0.6)]
    case = case_file(str(two_pieces), cube, options={"component": "all"})
    ran = crossview("render", case, "-o", tmp_path / "out" / "a.png", "--component", "2")
    refused(ran, tmp_path, "there is no component 2 (of 2)")
    options = ["--component", "1", "--size", "200x200"]
    assert crossview("render", case, "-o", tmp_path / "a.png", *options).status == 0
    assert (tmp_path / "a.png").stat().st_size > 0


def test_stl_is_merged_with_a_note(crossview: Crossview, tmp_path: Path) -> None:
    made = square(8)
    path = tmp_path / "square.stl"
    pv.PolyData.from_regular_faces(made.vertices, made.faces).save(path)
    assert crossview("solve", path, "-o", tmp_path / "out").status == 0
    report = json.loads((tmp_path / "out" / "report.json").read_text())
    assert report["surface"]["vertices"] == 81
    assert any("merged" in note for note in report["notes"])


def test_render_draws_the_chosen_layers(crossview: Crossview, tmp_path: Path) -> None:
    picture = tmp_path / "new" / "square.png"
    ran = crossview(
        "render", "square", "-o", picture, "--size", "200x150", "--scale", "2",
        "--layers", "surface,crosses", "--transparent",
    )  # fmt: skip
    assert ran.status == 0, ran.err
    assert ran.out == f"wrote {picture}\n"
    pixels = pv.read(picture)
    assert pixels.dimensions[:2] == (400, 300)
    colours = pixels.active_scalars
    assert colours.shape[1] == 4
    assert (colours[:, 3] == 0).any()
    assert (colours[:, 3] == 255).any()


def test_the_real_program(tmp_path: Path) -> None:
    assert run("--version").stdout.strip().count(".") == 2
    shown = run("--help")
    assert shown.returncode == 0
    for command in ("info", "solve", "render", "gallery"):
        assert command in shown.stdout
    ran = run("solve", "square", "-o", tmp_path / "out", "--json")
    assert (ran.returncode, ran.stderr) == (0, "")
    assert json.loads(ran.stdout)["isotropically_valid"]
    ran = run("solve", tmp_path / "none.json", "-o", tmp_path / "none")
    assert ran.returncode == 2
    assert ran.stderr.startswith("crossview: error: ")
    assert ran.stderr.count("\n") == 1
    assert not (tmp_path / "none").exists()


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="other systems have a screen")
@pytest.mark.parametrize("environment", [{}, {"DISPLAY": ":987"}])
def test_the_window_without_a_display_says_what_to_do(environment: dict[str, str]) -> None:
    ran = run("torus", **environment)
    assert ran.returncode == 2
    assert "no display" in ran.stderr
    assert "crossview render torus -o figure.png" in ran.stderr
    assert ran.stderr.count("\n") == 1


def test_long_work_shows_its_progress(case_file: CaseFile, tmp_path: Path) -> None:
    """A terminal sees a bar for work of more than a second, apart from the results."""
    path = case_file({"builtin": "square", "n": 400})
    ran = run("solve", path, "-o", tmp_path / "out", FORCE_COLOR="1", TERM="xterm")
    assert ran.returncode == 0, ran.stderr
    assert "━" in ran.stderr
    assert ran.stdout.endswith(f"wrote {tmp_path / 'out'}\n")
    assert "━" not in ran.stdout
    assert run("solve", path, "-o", tmp_path / "out").stderr == ""


@pytest.mark.skipif(sys.platform == "win32", reason="no such signal")
def test_ctrl_c_ends_in_one_line_and_leaves_nothing(case_file: CaseFile, tmp_path: Path) -> None:
    path = case_file({"builtin": "square", "n": 900})
    command: list[str | Path] = [PROGRAM, "solve", path, "-o", tmp_path / "out"]
    with subprocess.Popen(command, stdout=-1, stderr=-1, text=True) as program:
        while not list(tmp_path.glob(".crossview-*")):  # until it has begun
            assert program.poll() is None
            time.sleep(0.05)
        program.send_signal(signal.SIGINT)
        out, err = program.communicate(timeout=60)
    assert (program.returncode, out, err) == (130, "", "crossview: interrupted\n")
    assert [p.name for p in tmp_path.iterdir()] == ["case.json"]
