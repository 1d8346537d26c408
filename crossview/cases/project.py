"""Project files: a case and how it is looked at. Every tool reads the case in one."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from crossview.cases.json_values import CaseError, JsonField, read_json
from crossview.cases.model import Case
from crossview.cases.records import Record
from crossview.cases.scalars import Number
from crossview.io.staged_files import staged_file

PROJECT = ".crossview"
"""Ending of project files."""

VERSION = 1
"""Of what is written; raised when older programs would misread it."""


@dataclass(frozen=True)
class Project:
    """What a project file holds.

    Parameters
    ----------
    case : Case
    look : mapping of str to object
        Layers, camera and the like as JSON values, which the window reads.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> from crossview import Case
    >>> from crossview.cases.project import Project
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = Path(folder) / "mine.crossview"
    ...     Project(Case.from_json({"surface": "disk"}), {"camera": "xy"}).save(path)
    ...     found = Project.load(path)
    >>> found.case.surface.name, found.look
    ('disk', {'camera': 'xy'})
    """

    case: Case
    look: Mapping[str, Any] = field(default_factory=dict)

    @classmethod
    def load(cls, path: str | Path) -> Project:
        """Read a project file, of this version or an older one.

        Raises
        ------
        CaseError
            The file or the case in it is wrong, or a newer crossview has written it.
        """
        path = Path(path)
        members = _brought_up(read_json(path)).object(("crossview", "case"), ("look",))
        case = Record(Case).read(members["case"], path.parent)
        look = members["look"].object((), members["look"].value) if "look" in members else {}
        return cls(case, {name: entry.value for name, entry in look.items()})

    def save(self, path: str | Path) -> None:
        """Write the project file whole or not at all.

        Raises
        ------
        CrossviewError
            It cannot be written, or its name does not end in .crossview.
        """
        path = Path(path)
        if path.suffix.lower() != PROJECT:
            advice = f"a project's name ends in {PROJECT}"
            raise CaseError("cannot write a project under this name", str(path), advice)
        told = {"crossview": VERSION, "case": self.case.to_json(path.parent), "look": self.look}
        text = json.dumps(told, indent=2, ensure_ascii=False) + "\n"
        with staged_file(path, self.case.files) as made:
            made.write_text(text, encoding="utf-8")


def _brought_up(read: JsonField) -> JsonField:
    """Return what a file of any version up to this one would hold today."""
    value = read.value
    if not isinstance(value, dict) or "crossview" not in value:  # the case alone
        return JsonField({"crossview": VERSION, "case": value}, read.file)
    version = Number(whole=True, least=1).read(read.members()["crossview"], Path())
    if version > VERSION:
        raise read.error("a newer crossview has written this project", "open it with that one")
    return read
