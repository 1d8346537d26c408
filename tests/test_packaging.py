"""What is installed is what is there."""

import json
import re
import subprocess
import sys
import tomllib
from importlib.resources import files
from pathlib import Path

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
