"""Make an application that needs no Python: dist/crossview/, by PyInstaller.

PyInstaller is GPL with an exception for what it bundles, which keeps its own licence.

usage: python tools/bundle.py
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]

WHOLE = ("crossview", "solvers")
"""Packages taken with their sources: commands are described by them, and some run on their own."""

WITH_DATA = ("cmcrameri", "pyvista", "cyclopts", "rich")
"""Packages whose files are read as they run."""

LEFT_OUT = (
    *(
        "IPython",
        "babel",
        "dask",
        "distributed",
        "docutils",
        "gi",
        "hypothesis",
        "mypy",
        "numpydoc",
    ),
    *("pytest", "sphinx", "tkinter"),
)
"""What dependencies import where it is there, and crossview does without."""


def main() -> int:
    """Run PyInstaller."""
    options = ["--noconfirm", "--name", "crossview", "--icon", "NONE"]
    for name in WHOLE:
        options += ["--collect-submodules", name]
        folder = ROOT / name
        options += ["--add-data", f"{folder}:{name}"]
    options += ["--add-data", f"{ROOT / 'resources'}:crossview/resources"]
    options += ["--copy-metadata", "crossview"]
    for name in WITH_DATA:
        options += ["--collect-data", name, "--copy-metadata", name]
    for name in LEFT_OUT:
        options += ["--exclude-module", name]
    options += ["--distpath", str(ROOT / "dist"), "--workpath", str(ROOT / "build" / "bundle")]
    options += ["--specpath", str(ROOT / "build" / "bundle"), str(ROOT / "crossview_program.py")]
    return subprocess.run([sys.executable, "-m", "PyInstaller", *options], check=False).returncode


if __name__ == "__main__":
    sys.exit(main())
