"""What a command imports is what it needs."""

import subprocess
import sys
from pathlib import Path

import pytest

from crossview.cli import app

HEAVY = ("vtkmodules", "vtk", "pyvista", "matplotlib", "PySide6", "meshio")
NUMERICS = ("numpy", "scipy", "rslab")


def imported(*words: str, folder: Path) -> set[str]:
    """The packages that a command has imported when it ends."""
    program = (
        "import sys\nfrom crossview.cli import main\ntry:\n    main(sys.argv[1:])\n"
        "finally:\n    names = {name.partition('.')[0] for name in sys.modules}\n"
        "    open('names', 'w').write(' '.join(names))"
    )
    command = [sys.executable, "-c", program, *words]
    subprocess.run(command, cwd=folder, capture_output=True, check=True)
    return set((folder / "names").read_text().split())


@pytest.mark.parametrize("words", [("--help",), ("--version",)])
def test_what_only_tells_of_itself_needs_no_numerics(
    words: tuple[str, ...], tmp_path: Path
) -> None:
    assert not imported(*words, folder=tmp_path) & {*HEAVY, *NUMERICS}


@pytest.mark.parametrize(
    "words",
    [
        ("disk-5",),
        ("info", "disk"),
        ("complete", "disk", "-o", "case.json"),
        ("natural", "disk", "-o", "case.json"),
        ("make-valid", "disk-4", "-o", "case.json"),
        ("gallery", "--list"),
        ("schema",),
    ],
    ids=lambda words: words[0],
)
def test_what_draws_nothing_needs_no_drawing(words: tuple[str, ...], tmp_path: Path) -> None:
    assert not imported(*words, folder=tmp_path) & {*HEAVY}


def test_the_help_tells_of_each_command_what_it_tells_of_itself() -> None:
    for name in app:
        if name.startswith("-"):
            continue
        command = app[name]
        text = (command.default_command.__doc__ or "").strip() if command.default_command else ""
        assert command.help
        assert text.startswith(command.help.partition("\n")[0])
