"""crossview --install-desktop: the program among the applications of a Linux desktop."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from importlib.resources import files
from pathlib import Path

from crossview.cli.terminal import say
from crossview.io.staged_files import staged_file
from solvers.errors import CrossviewError

CASE_TYPE = "application/vnd.crossview.case+json"
"""The kind of case files, by names that end in ``.crossview.json``."""

SURFACE_TYPES = ("model/obj", "model/stl", "model/gltf+json", "model/gltf-binary")
"""Kinds of files that it is offered for besides."""

ENTRY = """[Desktop Entry]
Type=Application
Name=crossview
GenericName=Cross-field editor
Comment=Impose singularities on a surface and see its cross-field
Exec={command} %f
Icon=crossview
Terminal=false
Categories=Graphics;3DGraphics;
Keywords=quad mesh;cross-field;singularities;
MimeType={types};
StartupWMClass=crossview
"""
"""Of the menu of applications."""

KIND = f"""<?xml version="1.0" encoding="UTF-8"?>
<mime-info xmlns="http://www.freedesktop.org/standards/shared-mime-info">
  <mime-type type="{CASE_TYPE}">
    <comment>Case of crossview</comment>
    <sub-class-of type="application/json"/>
    <icon name="crossview"/>
    <glob pattern="*.crossview.json" weight="60"/>
  </mime-type>
</mime-info>
"""
"""Of case files, for the desktop."""

INK = "#2f6fde"
"""Of the icon, which has the colour of the text around it elsewhere."""

REFRESH = (
    ("update-desktop-database", "applications"),
    ("update-mime-database", "mime"),
    ("gtk-update-icon-cache", "icons/hicolor"),
)
"""Programs that tell a desktop what is new, and the folder that each looks at."""


def install_desktop() -> None:
    """Write the desktop entry, the icon and the kind of case files below XDG_DATA_HOME.

    Raises
    ------
    CrossviewError
        This is no Linux desktop, or the files cannot be written.
    """
    if not sys.platform.startswith("linux"):
        raise CrossviewError(
            "a desktop entry is for Linux", sys.platform, "make an application of it: make bundle"
        )
    data = Path(os.environ.get("XDG_DATA_HOME") or Path.home() / ".local" / "share")
    types = ";".join((CASE_TYPE, *SURFACE_TYPES))
    icon = (files("crossview.resources") / "icons" / "crossview.svg").read_text(encoding="utf-8")
    for place, text in (
        ("applications/crossview.desktop", ENTRY.format(command=_command(), types=types)),
        ("mime/packages/crossview.xml", KIND),
        ("icons/hicolor/scalable/apps/crossview.svg", icon.replace("currentColor", INK)),
    ):
        with staged_file(data / place) as made:
            made.write_text(text, encoding="utf-8")
        say(f"wrote {data / place}")
    for program, folder in REFRESH:
        if found := shutil.which(program):
            subprocess.run([found, str(data / folder)], capture_output=True, check=False)


def _command() -> str:
    """What starts this program, quoted as desktop entries want it."""
    started = [sys.executable]
    if not getattr(sys, "frozen", False):
        started += ["-P", "-m", "crossview"]  # not one of the folder that it is started in
    return " ".join(map(_quoted, started))


def _quoted(word: str) -> str:
    """A word of a command; in a desktop entry a backslash stands twice, a percent sign too."""
    for letter in '\\"`$':
        word = word.replace(letter, f"\\{letter}")
    return '"' + word.replace("\\", "\\\\").replace("%", "%%") + '"'
