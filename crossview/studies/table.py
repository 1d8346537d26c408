"""The table of a study: a row for each case."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Iterable, Sequence
from fnmatch import fnmatchcase
from typing import Any

from crossview.studies.ledger import FILES, Entry
from crossview.studies.outcome import REFUSED
from crossview.studies.plan import Refusal, Task

Row = dict[str, Any]
"""A case: its name, what was varied, what came of it, and its figures."""

FIRST = ("case", "status", "reason", "step", "seconds", "files")
"""Columns of all tables; those of what varies follow, then the figures."""


def row(task: Task, entry: Entry, patterns: Sequence[str], files: bool) -> Row:
    """Return the row of a case that has ended.

    Parameters
    ----------
    task : Task
        The case.
    entry : Entry
        What came of it.
    patterns : sequence of str
        Of the figures that are kept.
    files : bool
        Whether there are files of it.
    """
    kept = f"{FILES}/{entry.key}" if files else ""
    told = (task.name, entry.status, entry.reason, entry.step, entry.seconds, kept)
    figures = {
        name: value
        for name, value in entry.figures.items()
        if name not in task.varied and any(fnmatchcase(name, pattern) for pattern in patterns)
    }
    return dict(zip(FIRST, told, strict=True)) | dict(task.varied) | figures


def refused(refusal: Refusal) -> Row:
    """Return the row of a case that cannot be begun.

    Parameters
    ----------
    refusal : Refusal
        The case and what is wrong with it.
    """
    told = (refusal.name, REFUSED, refusal.reason, "reading", 0.0, "")
    return dict(zip(FIRST, told, strict=True)) | dict(refusal.varied)


def columns(rows: Iterable[Row]) -> list[str]:
    """Return the names of all columns, in the order in which they first stand.

    Parameters
    ----------
    rows : iterable of dict
        Of a table.
    """
    return list(dict.fromkeys(name for each in rows for name in each))


def as_csv(rows: Sequence[Row]) -> str:
    """Return a table as CSV (RFC 4180): lists as JSON, what there is none of as nothing.

    Parameters
    ----------
    rows : sequence of dict
        Of a table.
    """
    text = io.StringIO()
    writer = csv.DictWriter(text, columns(rows), lineterminator="\n")
    writer.writeheader()
    writer.writerows({name: _cell(value) for name, value in each.items()} for each in rows)
    return text.getvalue()


def _cell(value: Any) -> Any:
    if isinstance(value, list | tuple | dict | bool):
        return json.dumps(value)
    return value
