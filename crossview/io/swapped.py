"""A folder changed for another in one step, and what is written kept by the disk."""

from __future__ import annotations

import ctypes
import os
import stat
import sys
from pathlib import Path

MOST = 1000
"""Entries of a folder up to which it is changed as a whole. Chosen: some hundredths of a second."""

EXCHANGE, HERE = 2, -100
"""RENAME_EXCHANGE and AT_FDCWD of Linux."""


def swapped(made: Path, target: Path) -> bool:
    """Put a folder at the place of another in one step, the other's further files within it.

    Parameters
    ----------
    made : Path
        The new folder. Afterwards the old one is there, if there was one.
    target : Path
        Where it goes.

    Returns
    -------
    bool
        False if nothing was done: the system has no such step, someone stands in the folder, or
        it holds too much or something that cannot be in two folders.
    """
    try:
        if not target.exists():
            target.parent.mkdir(parents=True, exist_ok=True)
            _flush_below(made)
            made.rename(target)
        elif target not in made.parents and _stands_alone(target) and _link_others(target, made):
            made.chmod(stat.S_IMODE(target.stat().st_mode))
            _flush_below(made)
            if not _exchange(made, target):
                return False
        else:
            return False
    except OSError:
        return False
    flush(target.parent)
    return True


def flush(path: Path) -> None:
    """Wait until the disk has a file, or the names in a folder.

    Raises
    ------
    OSError
        The disk refuses, because it is full or broken.
    """
    if os.name != "posix" and path.is_dir():
        return
    handle = os.open(path, os.O_RDONLY if os.name == "posix" else os.O_RDWR)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


def _flush_below(folder: Path) -> None:
    for path in (folder, *(path for path in folder.rglob("*") if path.is_dir())):
        flush(path)


def _stands_alone(folder: Path) -> bool:
    """Whether a folder is no one's working directory here, no mount, and its owner's and ours."""
    here = Path(os.path.realpath(os.getcwd()))
    found = folder.stat()
    mine = found.st_uid == os.getuid() if hasattr(os, "getuid") else False
    return mine and folder != here and folder not in here.parents and not folder.is_mount()


def _link_others(source: Path, made: Path) -> bool:
    """Give a folder the further files of another; False if they are too many."""
    count = 0
    for at, folders, files in os.walk(source):
        place = made / Path(at).relative_to(source)
        count += len(folders) + len(files)
        if count > MOST or any((Path(at) / name).is_symlink() for name in (*folders, *files)):
            return False
        for name in folders:
            (place / name).mkdir(exist_ok=True)
            (place / name).chmod(stat.S_IMODE((Path(at) / name).stat().st_mode))
        for name in files:
            if not (place / name).exists():
                os.link(Path(at) / name, place / name)
    return True


def _exchange(one: Path, other: Path) -> bool:
    """Exchange the names of two folders, where the system can."""
    if sys.platform != "linux":
        return False
    rename = getattr(ctypes.CDLL(None, use_errno=True), "renameat2", None)
    if rename is None:
        return False
    names = (os.fsencode(path) for path in (one, other))
    first, second = (ctypes.c_char_p(name) for name in names)
    return bool(rename(HERE, first, HERE, second, ctypes.c_uint(EXCHANGE)) == 0)
