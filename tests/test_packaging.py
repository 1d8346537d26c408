"""What is installed is what is there."""

import json
import re
import subprocess
import sys
import tomllib
from fnmatch import fnmatch
from importlib.resources import files
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

import crossview
from tests.real_surfaces import DATA, KNOWN

ROOT = Path(__file__).resolve().parents[1]


def test_every_package_is_installed() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    installed = set(project["tool"]["setuptools"]["packages"])
    modules = [*ROOT.glob("crossview/**/__init__.py"), *ROOT.glob("solvers/**/__init__.py")]
    there = {".".join(path.parent.relative_to(ROOT).parts) for path in modules}
    assert installed == there | {"crossview.resources"}


def test_resources_are_found_through_the_package() -> None:
    resources = files("crossview.resources")
    assert any(entry.name.endswith(".json") for entry in (resources / "gallery").iterdir())
    assert any(entry.name.endswith(".svg") for entry in (resources / "icons").iterdir())


QT = ("PySide6-Essentials", "pyvistaqt")


def test_the_headless_requirements_are_all_but_qt() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    lines = (ROOT / "requirements-headless.txt").read_text(encoding="utf-8").splitlines()
    wanted = [need for need in project["project"]["dependencies"] if not need.startswith(QT)]
    assert [line for line in lines if not line.startswith("#")] == wanted


def without_qt(arguments: list[object], folder: Path) -> subprocess.CompletedProcess[str]:
    """Run a command line where neither PySide6 nor pyvistaqt can be imported."""
    program = (
        "import sys; sys.modules |= dict.fromkeys(['PySide6', 'pyvistaqt', 'qtpy', 'shiboken6']); "
        "from crossview.cli import main; sys.exit(main(sys.argv[1:]))"
    )
    command = [sys.executable, "-c", program, *map(str, arguments)]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)


def test_all_but_the_window_works_without_qt(tmp_path: Path) -> None:
    solved = without_qt(["solve", "disk-4", "-o", "out", "--quads", "--quiet"], tmp_path)
    assert (solved.returncode, solved.stderr) == (0, "")
    report = json.loads((tmp_path / "out" / "report.json").read_text(encoding="utf-8"))
    assert report["layout"]["patches"] == 5
    drawn = without_qt(["render", "disk-4", "-o", "figure.png"], tmp_path)
    assert (drawn.returncode, (tmp_path / "figure.png").exists()) == (0, True)
    window = without_qt(["disk-4"], tmp_path)
    assert window.returncode == 2
    assert window.stderr.count("\n") == 1
    assert "the window needs PySide6 and pyvistaqt" in window.stderr


def test_every_surface_of_the_tests_has_its_licence_beside_it() -> None:
    told = (DATA / "LICENSES.txt").read_text(encoding="utf-8")
    there = {path.name for path in DATA.iterdir()} - {"LICENSES.txt"}
    assert there == set(re.findall(r"^(\S+)\n  source : .+\n  licence: .+$", told, re.MULTILINE))
    assert there <= set(KNOWN)


def test_the_citation_names_this_version() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    citation = (ROOT / "CITATION.cff").read_text(encoding="utf-8").splitlines()
    for key in ("version", "license"):
        assert f"{key}: {project[key]}" in citation


def test_the_lock_file_has_every_dependency_in_a_version_that_is_allowed() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    lines = (ROOT / "requirements-lock.txt").read_text(encoding="utf-8").splitlines()
    locked = dict(line.split("==") for line in lines if not line.startswith("#"))
    versions = {canonicalize_name(name): version for name, version in locked.items()}
    for need in map(
        Requirement, project["dependencies"] + project["optional-dependencies"]["test"]
    ):
        if need.marker is None or need.marker.evaluate({"python_version": "3.11"}):
            assert versions[canonicalize_name(need.name)] in need.specifier


def test_the_archive_holds_what_is_under_version_control() -> None:
    listed = subprocess.run(
        ["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=False
    )
    if listed.returncode:
        pytest.skip("not under version control here")
    rules = [line.split() for line in (ROOT / "MANIFEST.in").read_text("utf-8").splitlines()]
    taken = {"crossview", "solvers", *(rule[1] for rule in rules if rule[:1] == ["graft"])}
    patterns = next(rule[1:] for rule in rules if rule[:1] == ["include"])
    modules = {"pyproject.toml", "crossview_program.py", "LICENSE"}
    for name in listed.stdout.splitlines():
        top, _, below = name.partition("/")
        if below:
            assert top in taken, name
        else:
            assert name in modules or any(fnmatch(name, each) for each in patterns), name


ELSEWHERE = """
import importlib, pkgutil, sys
sys.modules |= dict.fromkeys(["fcntl", "resource", "pwd", "grp", "termios"])
import crossview, solvers
for package in (crossview, solvers):
    for module in pkgutil.walk_packages(package.__path__, package.__name__ + "."):
        if module.name not in ("crossview.__main__", "crossview.studies.child"):
            importlib.import_module(module.name)
"""


def test_all_is_imported_on_a_system_that_is_not_posix() -> None:
    ran = subprocess.run(
        [sys.executable, "-c", ELSEWHERE], capture_output=True, text=True, check=False
    )
    assert (ran.returncode, ran.stderr) == (0, "")


def test_python_runs_the_package_as_the_command(tmp_path: Path) -> None:
    ran = subprocess.run(
        [sys.executable, "-P", "-m", "crossview", "--version"],
        cwd=tmp_path, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert (ran.returncode, ran.stdout.strip()) == (0, crossview.__version__)
    wrong = subprocess.run(
        [sys.executable, "-P", "-m", "crossview", "info", "nothing"],
        cwd=tmp_path, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert (wrong.returncode, wrong.stderr.count("\n")) == (2, 1)


BUNDLED = """
import sys
sys.frozen = True
from crossview_program import main
sys.exit(main())
"""


def test_a_bundle_is_its_own_python(tmp_path: Path) -> None:
    """VTK's formats are read, and cases of a study worked on, in processes of their own."""
    script = tmp_path / "script.py"
    script.write_text("import sys; print(__name__, *sys.argv[1:])")
    for program in (["-c", script.read_text()], [str(script)]):
        ran = subprocess.run(
            [sys.executable, "-c", BUNDLED, "-P", *program, "a", "b"],
            capture_output=True, text=True, check=False,
        )  # fmt: skip
        assert (ran.returncode, ran.stdout) == (0, "__main__ a b\n"), ran.stderr
