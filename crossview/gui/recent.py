"""Recent files, kept in the user's settings."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QSettings

KEY, MOST = "recent", 10
"""Where settings keep the recent files, and how many. Chosen."""


def recent() -> tuple[str, ...]:
    """Return the paths last opened that still exist, the newest first."""
    value = QSettings().value(KEY)
    # a list of one comes back from an INI file as the one
    paths = value if isinstance(value, list) else [value] if isinstance(value, str) else []
    return tuple(path for path in paths if Path(path).exists())


def remember(path: str) -> None:
    """Put `path` first among the recent files."""
    absolute = str(Path(path).resolve())
    others = [other for other in recent() if other != absolute]
    QSettings().setValue(KEY, [absolute, *others][:MOST])


def forget_all() -> None:
    """Empty the list."""
    QSettings().remove(KEY)
