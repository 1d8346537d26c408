"""Copies of unsaved work, of this window and of those that ended without closing."""

from __future__ import annotations

import shutil
import tempfile
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

from PySide6.QtCore import QLockFile, QStandardPaths

from crossview.session.document import Document

LOCK, SOURCE = "lock", "source"
"""Files beside a copy: held by a window that lives, and what the case was opened from."""


@dataclass(frozen=True)
class Unsaved:
    """A copy of unsaved work.

    Parameters
    ----------
    case : Path
        The case file.
    source : str
        What it was opened from.
    """

    case: Path
    source: str

    @property
    def words(self) -> str:
        """What it is, for a button's question."""
        edited = datetime.fromtimestamp(self.case.stat().st_mtime)
        today = edited.date() == datetime.now().date()
        return f"{self.case.stem}, edited {edited:{'%H:%M' if today else '%d %B, %H:%M'}}"

    def forget(self) -> None:
        """Remove the copy."""
        shutil.rmtree(self.case.parent, ignore_errors=True)


class Recovery:
    """Keeps a copy of what one window has not saved.

    A folder of its own holds the copy and a lock, which the system lets go when the window's
    process ends, however it does.
    """

    def __init__(self) -> None:
        self._folder: Path | None = None
        self._lock: QLockFile | None = None

    def keep(self, document: Document, source: str) -> None:
        """Write a copy in place of the last one.

        Raises
        ------
        CrossviewError, OSError
            It cannot be written.
        """
        folder = self._own_folder()
        (folder / SOURCE).write_text(source, encoding="utf-8")
        document.to_case().save(folder / f"{document.name}.json")  # whole or not at all

    def clear(self) -> None:
        """Remove the copy: it is saved, or given up."""
        if self._folder is not None and self._lock is not None:
            shutil.rmtree(self._folder, ignore_errors=True)
            self._lock.unlock()
            self._folder = self._lock = None

    def _own_folder(self) -> Path:
        if self._folder is None:
            base = _base()
            base.mkdir(parents=True, exist_ok=True)
            self._folder = Path(tempfile.mkdtemp(dir=base))
            self._lock = _lock(self._folder)
            self._lock.tryLock(0)
        return self._folder


def unsaved() -> list[Unsaved]:
    """Return the copies left by windows that live no more, the last edited first."""
    found = []
    for folder in _base().glob("*"):
        lock = _lock(folder)
        if not lock.tryLock(0):
            continue
        lock.unlock()
        cases = list(folder.glob("*.json"))
        if not cases:  # it ended before its first copy
            shutil.rmtree(folder, ignore_errors=True)
            continue
        source = (folder / SOURCE).read_text(encoding="utf-8", errors="replace")
        found += [Unsaved(case, source) for case in cases]
    return sorted(found, key=lambda one: one.case.stat().st_mtime, reverse=True)


def _base() -> Path:
    where = QStandardPaths.StandardLocation.AppLocalDataLocation
    return Path(QStandardPaths.writableLocation(where)) / "unsaved"


def _lock(folder: Path) -> QLockFile:
    lock = QLockFile(str(folder / LOCK))
    lock.setStaleLockTime(0)  # stale when its process has ended, and no sooner
    return lock
