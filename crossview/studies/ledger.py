"""The folder of a study: a line for each case that has ended, and the files of each."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, BinaryIO

from crossview.io.staged_files import staged, unwritable
from crossview.studies.limits import Limits
from crossview.studies.outcome import DIED, OUT_OF_MEMORY, TIMED_OUT, Outcome
from solvers.errors import CrossviewError

LINES, FILES = "rows.jsonl", "files"
"""The file of lines, and the folder with a folder of files for each case."""


@dataclass(frozen=True)
class Entry:
    """A case that has ended.

    Parameters
    ----------
    key : str
        Of the task.
    status, reason, step, seconds, figures
        As of `Outcome`.
    limits : mapping of str to float
        Those that it ended within.
    """

    key: str
    status: str
    reason: str
    step: str
    seconds: float
    figures: Mapping[str, Any]
    limits: Mapping[str, float | None]

    def stands(self, limits: Limits) -> bool:
        """Whether the case need not be worked on again within other limits.

        Parameters
        ----------
        limits : Limits
            Those of now: wider ones may let it end well. What died is always tried again.
        """
        if self.status == TIMED_OUT:
            return limits.seconds <= float(self.limits["seconds"] or 0)
        if self.status == OUT_OF_MEMORY:
            before, now = self.limits["gigabytes"], limits.gigabytes
            return before is None or (now is not None and now <= before)
        return self.status != DIED


class Ledger:
    """What has ended in a folder, kept through kills: a line is whole or is not counted.

    Parameters
    ----------
    folder : Path
        Of the study.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._file = (folder / LINES).open("a+b")
        try:
            _lock(self._file)
        except OSError as error:
            self._file.close()
            raise CrossviewError(
                "another batch is at work in this folder", str(folder), "wait for it"
            ) from error
        self.entries = self._read()

    def _read(self) -> dict[str, Entry]:
        """The last entry of each case; a last line that was cut short is removed."""
        self._file.seek(0)
        text = self._file.read()
        whole = text[: text.rfind(b"\n") + 1]
        self._file.truncate(len(whole))
        try:
            entries = [Entry(**json.loads(line)) for line in whole.splitlines()]
        except (ValueError, TypeError) as error:
            place = str(self.folder / LINES)
            raise CrossviewError("the rows of this folder cannot be read", place) from error
        return {entry.key: entry for entry in entries}

    def home(self, key: str) -> Path:
        """Return where the files of a case are kept.

        Parameters
        ----------
        key : str
            Of its task.
        """
        return self.folder / FILES / key

    def add(self, key: str, outcome: Outcome, limits: Limits) -> None:
        """Keep what came of a case: first its files, then its line.

        Parameters
        ----------
        key : str
            Of its task.
        outcome : Outcome
            What came of it.
        limits : Limits
            Those it ended within.

        Raises
        ------
        CrossviewError
            The folder cannot be written.
        """
        if outcome.files:
            with staged(self.home(key)) as staging:
                for name, content in outcome.files.items():
                    (staging / name).write_bytes(content)
        entry = Entry(
            key,
            outcome.status,
            outcome.reason,
            outcome.step,
            round(outcome.seconds, 6),
            outcome.figures,
            asdict(limits),
        )
        self._file.write(json.dumps(asdict(entry), ensure_ascii=False).encode() + b"\n")
        self._file.flush()
        self.entries[key] = entry

    def close(self) -> None:
        """Let others work in the folder."""
        self._file.close()


@contextmanager
def ledger(folder: Path) -> Iterator[Ledger]:
    """Open the ledger of a folder, made with its parents if missing.

    Parameters
    ----------
    folder : Path
        Of the study.

    Raises
    ------
    CrossviewError
        It cannot be written, or another batch is at work in it.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        opened = Ledger(folder)
    except OSError as error:
        raise unwritable(folder, error) from error
    try:
        yield opened
    finally:
        opened.close()


def _lock(file: BinaryIO) -> None:
    """Keep a file to this process; OSError if another has it. Elsewhere than here no batch runs."""
    import fcntl

    fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
