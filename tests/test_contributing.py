"""What CONTRIBUTING.md and the file for public hosting say of the tree is so."""

import re
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
TEXT = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
HOSTING = (ROOT / ".github/workflows/ci.yml").read_text(encoding="utf-8")
PATH = r"`((?:crossview|solvers|tests|docs|resources)/(?!.*ROOM)[\w/.]+)`"
TESTED = r"tests/[\w/.]+"


def floors(name: str) -> list[str]:
    """The rooms of each floor by a contract, as the picture has them."""
    contracts = PROJECT["tool"]["importlinter"]["contracts"]
    (layers,) = [c["layers"] for c in contracts if c["name"] == name]
    return [floor.replace("crossview.", "") for floor in layers if floor != "solvers"]


def test_the_picture_shows_the_floors_of_the_contracts() -> None:
    (picture,) = re.findall(r"```text\n(crossview .*?)```", TEXT, re.DOTALL)
    upper, lower = re.split(r"-+\n", picture.replace("crossview", "").replace("solvers", ""))
    shown = [[line.strip() for line in part.splitlines()] for part in (upper, lower)]
    assert shown == [floors("The floors of the program"), floors("The floors of the numerics")]


def test_each_room_is_told_of() -> None:
    for package in ("crossview", "solvers"):
        for room in (ROOT / package).glob("*/__init__.py"):
            assert f"| `{room.parent.name}`" in TEXT or f", `{room.parent.name}` |" in TEXT


@pytest.mark.parametrize("path", sorted({*re.findall(PATH, TEXT), *re.findall(TESTED, HOSTING)}))
def test_the_files_named_are_there(path: str) -> None:
    assert (ROOT / path).exists()
