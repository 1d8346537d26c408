"""Options that several commands share: the same help and the same checks in each."""

import re
from pathlib import Path

import pytest

from tests.command_line import Crossview

SURFACE = ("component", "repair")
TAKEN = {
    "info": SURFACE,
    "complete": SURFACE,
    "make-valid": SURFACE,
    "natural": (*SURFACE, "features"),
    "solve": (
        *SURFACE,
        "features",
        "method",
        "edge-length",
        "target-quads",
        "max-chord",
        "max-size-ratio",
    ),
    "render": (
        *SURFACE,
        "features",
        "method",
        "edge-length",
        "target-quads",
        "max-chord",
        "max-size-ratio",
    ),
}


def helped(crossview: Crossview, command: str) -> dict[str, str]:
    """What --help says of each option, its line breaks taken out."""
    lines = [line.strip("│ ") for line in crossview(command, "--help").out.splitlines()]
    text = " ".join(" ".join(lines).split())
    parts = re.split(r" (?:\* )?--([a-z-]+) ", text)
    told = zip(parts[1::2], parts[2::2], strict=True)
    return {name: re.split(r"[╰╭]", said)[0].strip() for name, said in told}


def test_shared_options_are_told_in_the_same_words(
    crossview: Crossview, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "100")
    said = {command: helped(crossview, command) for command in TAKEN}
    for command, options in TAKEN.items():
        for option in options:
            assert said[command][option] == said["render"][option], (command, option)
            assert said[command][option].endswith(".")
    assert "method" not in said["info"]
    assert said["natural"]["method"] != said["solve"]["method"]  # it is another one


WRONG = {
    "component": {
        "biggest": '"largest", "all" or a whole number from 0 on, found "biggest"',
        "-1": 'found "-1" (--component)',
    },
    "features": {"400": "above 0 and at most 180, found 400.0 (--features)"},
    "method": {"algned": 'unknown method "algned"'},
}


@pytest.mark.parametrize(
    ("command", "option"), [(c, o) for c in TAKEN for o in TAKEN[c] if o in WRONG]
)
def test_they_are_checked_alike(
    crossview: Crossview, tmp_path: Path, command: str, option: str
) -> None:
    output = () if command == "info" else ("-o", tmp_path / "out.png")
    for value, said in WRONG[option].items():
        ran = crossview(command, "disk-4", f"--{option}={value}", *output)
        assert ran.status == 2
        assert said in ran.err
        assert list(tmp_path.iterdir()) == []
