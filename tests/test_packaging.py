"""What is installed is what is there."""

import tomllib
from importlib.resources import files
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


def test_every_package_is_installed():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    installed = set(project["tool"]["setuptools"]["packages"])
    modules = [*ROOT.glob("crossview/**/__init__.py"), *ROOT.glob("solvers/**/__init__.py")]
    there = {".".join(path.parent.relative_to(ROOT).parts) for path in modules}
    assert installed == there | {"crossview.resources"}


def test_resources_are_found_through_the_package():
    resources = files("crossview.resources")
    assert any(entry.name.endswith(".json") for entry in (resources / "gallery").iterdir())
    assert any(entry.name.endswith(".svg") for entry in (resources / "icons").iterdir())
