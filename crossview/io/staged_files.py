"""Nothing half written: files are made in a temporary folder and moved when all are done."""

from __future__ import annotations

import errno
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from solvers.errors import CrossviewError


@contextmanager
def staged(directory: str | Path) -> Iterator[Path]:
    """A temporary folder whose contents move to `directory` if the block ends well.

    Files of the same name are replaced, others stay. If the block raises, nothing has changed.

    Parameters
    ----------
    directory : path
        Where the files go; made with its parents if missing.

    Raises
    ------
    CrossviewError
        `directory` cannot be made or written; told before the block runs.
    """
    target = Path(directory)
    try:
        # on the same file system, so that moving is renaming
        base = next(p for p in (target, *target.absolute().parents) if p.exists())
        staging = Path(tempfile.mkdtemp(prefix=".crossview-", dir=base))
    except OSError as error:
        raise unwritable(target, error) from error
    try:
        yield staging
        try:
            _move(staging, target)
        except OSError as error:
            raise unwritable(target, error) from error
    finally:
        shutil.rmtree(staging, ignore_errors=True)


def _move(staging: Path, target: Path) -> None:
    """Move all files below `staging` to the same places below `target`; all or none."""
    files = [path for path in sorted(staging.rglob("*")) if not path.is_dir()]
    places = [target / path.relative_to(staging) for path in files]
    for place in places:
        if place.is_dir():
            raise IsADirectoryError(errno.EISDIR, f"{place.name} is a folder")
    for path, place in zip(files, places, strict=True):
        place.parent.mkdir(parents=True, exist_ok=True)
        path.replace(place)


def unwritable(target: Path, error: OSError) -> CrossviewError:
    """Return the error that says why nothing is written there."""
    return CrossviewError(f"cannot write, {error.strerror}", str(target), "choose another place")
