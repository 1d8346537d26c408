"""The case inside a figure, with its camera and version, as text that any format carries."""

from __future__ import annotations

import base64
import binascii
import json
import os
import re
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any

from crossview.cases.json_values import CaseError
from crossview.cases.model import Case

FIGURES = (".png", ".svg", ".pdf", ".html")
"""Endings of files that figures are written to."""

_FOUND = re.compile(rb"crossview-case:([A-Za-z0-9+/=]+):")
"""What `Pictured.words` writes, anywhere in a file."""


@dataclass(frozen=True)
class Pictured:
    """What a figure shows.

    Parameters
    ----------
    case : Case
    camera : str
        From where it is seen, as of ``crossview render --camera``.

    Examples
    --------
    >>> from crossview import Case
    >>> from crossview.cases.pictured import Pictured
    >>> words = Pictured(Case.from_json({"surface": "disk"}), "xy").words(".")
    >>> words.startswith("crossview-case:")
    True
    """

    case: Case
    camera: str

    def words(self, folder: str | Path) -> str:
        """Return the text that a figure in `folder` carries: letters, digits, + / = and colons."""
        place = os.path.abspath(folder)
        told = {
            "version": version("crossview"),
            "folder": place,
            "camera": self.camera,
            "case": self.case.to_json(place),
        }
        return f"crossview-case:{base64.b64encode(json.dumps(told).encode()).decode()}:"

    @classmethod
    def load(cls, path: str | Path) -> Pictured:
        """Read what a figure shows.

        Its surface is looked for beside the figure as it was, then where it was then.

        Raises
        ------
        CaseError
            The file cannot be read, or is no figure of crossview's with its case in it.
        """
        path = Path(path)
        try:
            found = _FOUND.search(path.read_bytes())
        except OSError as error:
            raise CaseError(f"cannot read the figure, {error.strerror}", str(path)) from error
        if found is None:
            advice = "figures that crossview has written since it embeds their cases do"
            raise CaseError("this picture holds no case", str(path), advice)
        try:
            told: dict[str, Any] = json.loads(base64.b64decode(found[1], validate=True))
            camera, place, data = str(told["camera"]), str(told["folder"]), dict(told["case"])
        except (binascii.Error, KeyError, TypeError, ValueError) as error:
            raise CaseError("the case in this picture is damaged", str(path)) from error
        case = Case.from_json(data, path.parent)
        if isinstance(case.surface, str) and not os.path.exists(case.surface):
            case = Case.from_json(data, place)
        return cls(case, camera)
