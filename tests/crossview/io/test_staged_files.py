"""Files are written whole or not at all, to places where files may be, and leave nothing behind."""

import json
import os
import stat
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from crossview.io.staged_files import staged, staged_file
from crossview.io.staging import staging_in
from solvers.errors import CrossviewError


def contents(folder: Path) -> dict[str, str]:
    """All files below a folder, hidden ones, too."""
    files = (path for path in folder.rglob("*") if path.is_file())
    return {str(path.relative_to(folder)): path.read_text() for path in files}


def write(folder: Path, said: str) -> None:
    with staged(folder) as staging:
        (staging / "part").mkdir()
        for name in ("a", "part/b", "report.json"):
            (staging / name).write_text(said)


RESULTS = ("a", "part/b", "report.json")


def test_a_folder_gets_new_files_and_keeps_others(tmp_path: Path) -> None:
    out = tmp_path / "deep" / "out"
    write(out, "old")
    (out / "part" / "mine").write_text("mine")
    (out / "notes").write_text("mine")
    out.chmod(0o750)
    write(out, "new")
    mine = {"part/mine": "mine", "notes": "mine"}
    assert contents(tmp_path) == {
        f"deep/out/{name}": said for name, said in {**dict.fromkeys(RESULTS, "new"), **mine}.items()
    }
    assert stat.S_IMODE(out.stat().st_mode) == 0o750


def test_a_folder_made_anew_is_as_open_as_any(tmp_path: Path) -> None:
    write(tmp_path / "out", "new")
    (tmp_path / "other").mkdir()
    assert (tmp_path / "out").stat().st_mode == (tmp_path / "other").stat().st_mode


def test_the_working_directory_stays_the_same_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write(tmp_path / "out", "old")
    monkeypatch.chdir(tmp_path / "out")
    write(Path("."), "new")
    assert contents(Path(".")) == dict.fromkeys(RESULTS, "new")
    assert Path(".").samefile(tmp_path / "out")


KILLED = """
import json, os, signal, sys
from pathlib import Path
from crossview.io.staged_files import staged

CHANGES = {"os.rename", "os.link", "os.chmod", "os.mkdir", "os.remove", "ctypes.call_function"}

def write(folder, said):
    with staged(folder) as staging:
        for name in ("a", "report.json"):
            (staging / name).write_text(said)

def killed(folder, left):
    def count(event, arguments):
        nonlocal left
        left -= event in CHANGES
        if left < 0 and event in CHANGES:
            os.kill(os.getpid(), signal.SIGKILL)
    sys.addaudithook(count)
    write(folder, "new")

for step in range(100):
    folder = Path(sys.argv[1]) / str(step) / "out"
    write(folder, "old")
    (folder / "notes").write_text("mine")
    child = os.fork()
    if not child:
        killed(folder, step)
        os._exit(0)
    status = os.waitpid(child, 0)[1]
    found = {path.name: path.read_text() for path in folder.iterdir()}
    write(folder, "newer")
    print(json.dumps([status, found, os.listdir(folder.parent)]))
    if status == 0:
        break
"""


def test_a_kill_between_any_two_steps_leaves_old_or_new_results(tmp_path: Path) -> None:
    """Processes are killed before their first, second, ... change of the disk."""
    command = [sys.executable, "-c", KILLED, str(tmp_path)]
    ran = subprocess.run(command, capture_output=True, text=True, check=True)
    statuses, found, beside = zip(*map(json.loads, ran.stdout.splitlines()), strict=True)
    assert set(statuses[:-1]) == {9}
    assert statuses[-1] == 0
    assert {tuple(sorted(files.items())) for files in found} == {
        (("a", said), ("notes", "mine"), ("report.json", said)) for said in ("old", "new")
    }
    assert all(names == ["out"] for names in beside)  # the next one sweeps what was left behind


def write_and_fail(path: Path) -> None:
    path.write_text("new")
    raise ZeroDivisionError


def test_a_block_that_fails_changes_nothing(tmp_path: Path) -> None:
    write(tmp_path / "out", "old")
    with pytest.raises(ZeroDivisionError), staged(tmp_path / "out") as staging:
        write_and_fail(staging / "a")
    with pytest.raises(ZeroDivisionError), staged_file(tmp_path / "out" / "a") as made:
        write_and_fail(made)
    assert contents(tmp_path / "out") == dict.fromkeys(RESULTS, "old")
    assert [path.name for path in tmp_path.iterdir()] == ["out"]


def test_a_file_is_written_through_links_and_keeps_its_mode(tmp_path: Path) -> None:
    real, link = tmp_path / "real" / "case.json", tmp_path / "link.json"
    real.parent.mkdir()
    real.write_text("old")
    real.chmod(0o640)
    link.symlink_to("real/case.json")
    with staged_file(link) as made:
        made.write_text("new")
    assert link.is_symlink()
    assert real.read_text() == "new"
    assert stat.S_IMODE(real.stat().st_mode) == 0o640


def test_no_file_replaces_a_folder_a_pipe_or_a_device(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "folder").mkdir()
    (tmp_path / "null").symlink_to("/dev/null")
    for name in ("pipe", "folder", "null"):
        said = pytest.raises(CrossviewError, match=r"cannot write, .* is a")
        with said, staged_file(tmp_path / name):
            pytest.fail("told too late")
        said = pytest.raises(CrossviewError, match=r"cannot write, .* is a")
        with said, staged(tmp_path) as staging:
            (staging / name).write_text("x")
    assert stat.S_ISFIFO((tmp_path / "pipe").stat().st_mode)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["folder", "null", "pipe"]


def test_what_files_are_made_from_is_not_overwritten(tmp_path: Path) -> None:
    surface = tmp_path / "surface.obj"
    surface.write_text("mine")
    (tmp_path / "link.obj").symlink_to(surface)
    for target in (surface, tmp_path / "link.obj"):
        said = pytest.raises(CrossviewError, match="overwrite what it is made from")
        with said, staged_file(target, [surface]):
            pytest.fail("told too late")
    said = pytest.raises(CrossviewError, match="overwrite what it is made from")
    with said, staged(tmp_path, [str(surface)]) as staging:
        (staging / "surface.obj").write_text("new")
    assert surface.read_text() == "mine"


def test_folders_of_dead_processes_are_swept_those_of_live_ones_stay(tmp_path: Path) -> None:
    asked = (
        "import sys; from pathlib import Path; from crossview.io.staging import staging_in; "
        "made = staging_in(Path(sys.argv[1])); made.mkdir(); print(made)"
    )
    command = [sys.executable, "-c", asked, str(tmp_path)]
    dead = subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()
    alive = staging_in(tmp_path)
    alive.mkdir()
    (tmp_path / ".crossview-elsewhere-1-abc").mkdir()
    assert Path(dead).is_dir()
    with staged_file(tmp_path / "x") as made:
        made.write_text("x")
    assert not Path(dead).exists()
    assert alive.is_dir()
    assert (tmp_path / ".crossview-elsewhere-1-abc").is_dir()


@pytest.fixture
def small_files() -> Iterator[None]:
    """No file of this process grows above 20 000 bytes, as on a disk that is nearly full."""
    resource = pytest.importorskip("resource")
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, hard))
    yield
    resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))


@pytest.mark.usefixtures("small_files")
def test_a_disk_that_is_full_is_one_line(tmp_path: Path) -> None:
    full = pytest.raises(CrossviewError, match="cannot write, File too large")
    with full, staged_file(tmp_path / "file") as made:
        made.write_bytes(bytes(30_000))
    full = pytest.raises(CrossviewError, match="cannot write, File too large")
    with full, staged(tmp_path / "folder") as staging:
        (staging / "x").write_bytes(bytes(30_000))
    assert list(tmp_path.iterdir()) == []


@pytest.mark.usefixtures("small_files")
def test_a_file_within_a_folder_is_told_by_the_place_that_was_named(tmp_path: Path) -> None:
    full = pytest.raises(CrossviewError, match="cannot write, File too large")
    with full as caught, staged(tmp_path / "folder") as staging, staged_file(staging / "x") as made:
        made.write_bytes(bytes(30_000))
    assert caught.value.where == str(tmp_path / "folder")
