"""Temporary folders of files that are being made, and the end of those that a kill left behind."""

from __future__ import annotations

import os
import platform
import re
import secrets
import shutil
from pathlib import Path

PREFIX = ".crossview-"
"""How the names of such folders begin; the computer and the process that makes the files follow."""


def staging_in(base: Path) -> Path:
    """Return where in a folder a temporary one may be made."""
    return base / f"{PREFIX}{_computer()}-{os.getpid()}-{secrets.token_hex(4)}"


def remove(folder: Path) -> None:
    """Remove a folder, also if that is interrupted once."""
    try:
        shutil.rmtree(folder, ignore_errors=True)
    except KeyboardInterrupt:
        shutil.rmtree(folder, ignore_errors=True)
        raise


def sweep(base: Path) -> None:
    """Remove the temporary folders in another whose processes on this computer are dead."""
    if os.name != "posix":  # elsewhere asking for a process may end it
        return
    name = re.compile(re.escape(f"{PREFIX}{_computer()}-") + r"(\d{1,9})-\w+")
    try:
        entries = os.listdir(base)
    except PermissionError:  # one may still be allowed to write there
        return
    for entry in entries:
        found = name.fullmatch(entry)
        if found and not _lives(int(found[1])):
            shutil.rmtree(base / entry, ignore_errors=True)


def _computer() -> str:
    """The computer's name: others may write to the same folder over a network."""
    return re.sub(r"[^A-Za-z0-9]", "", platform.node())[:40] or "local"


def _lives(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except (PermissionError, OverflowError):
        return True
    return True
