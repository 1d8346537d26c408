"""Nothing half written: files are made in a temporary folder and moved when all are done."""

from __future__ import annotations

import errno
import os
import stat
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

from crossview.io.staging import remove, staging_in, sweep
from crossview.io.swapped import flush, swapped
from solvers.errors import CrossviewError

ELSEWHERE = "choose another place"
"""What to do where nothing can be written."""


class Unwritable(CrossviewError):
    """Nothing can be written somewhere; parameters as of `CrossviewError`."""


@contextmanager
def staged(directory: str | Path, kept: Iterable[str | Path] = ()) -> Iterator[Path]:
    """A temporary folder whose contents move to `directory` if the block ends well.

    Files of the same name are replaced, others stay. If the block raises, nothing has changed.

    Parameters
    ----------
    directory : path
        Where the files go; made with its parents if missing.
    kept : iterable of path
        Files that none of these may replace, such as the surface that they are made from.

    Raises
    ------
    CrossviewError
        `directory` cannot be made or written, told before the block runs where that is known; or
        the block cannot write.
    """
    target = Path(os.path.realpath(directory))
    alone = target.exists() and (target.is_mount() or not os.access(target.parent, os.W_OK))
    with _staging(target if alone else target.parent, Path(directory)) as staging:
        if target.exists():
            _require_folder(target)
        made = staging / "made"
        made.mkdir()
        yield made
        places = [target / path.relative_to(made) for path in _files(made)]
        for place in places:
            _require_replaceable(place)
        _require_none_of(places, kept)
        _move(made, target)


@contextmanager
def staged_file(path: str | Path, kept: Iterable[str | Path] = ()) -> Iterator[Path]:
    """A temporary place for a file that moves to `path` if the block ends well.

    If `path` is a link the file that it leads to is replaced; its mode is kept.

    Parameters
    ----------
    path : path
        Where the file goes; folders are made if missing.
    kept : iterable of path
        Files that this one may not replace, such as the surface that it is made from.

    Raises
    ------
    CrossviewError
        `path` is a folder, a device or a pipe, or one of `kept`, or cannot be written, told before
        the block runs; or the block cannot write.
    """
    target = Path(os.path.realpath(path))
    with _staging(target.parent, Path(path)) as staging:
        _require_replaceable(target)
        _require_none_of([target], kept)
        made = staging / Path(path).name
        yield made
        _take_mode(made, target)
        flush(made)
        target.parent.mkdir(parents=True, exist_ok=True)
        made.replace(target)
        flush(target.parent)


@contextmanager
def _staging(folder: Path, named: Path) -> Iterator[Path]:
    """A temporary folder on the same file system, so that moving is renaming."""
    try:
        base = next(p for p in (folder, *folder.parents) if p.exists())
        sweep(base)
        staging = staging_in(base)
    except OSError as error:
        raise unwritable(named, error) from error
    try:
        staging.mkdir(mode=0o700)  # within, so that no interruption comes between
        yield staging
    except Unwritable as error:  # a file within, whose temporary place means nothing to anyone
        raise Unwritable(error.what, str(named), ELSEWHERE) from error
    except OSError as error:
        raise unwritable(named, error) from error
    finally:
        remove(staging)


def _require_folder(target: Path) -> None:
    """Raise OSError unless files can be put into an existing folder."""
    if not target.is_dir():
        raise NotADirectoryError(errno.ENOTDIR, os.strerror(errno.ENOTDIR))
    if not os.access(target, os.W_OK | os.X_OK):
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))


def _files(folder: Path) -> list[Path]:
    return [path for path in sorted(folder.rglob("*")) if not path.is_dir()]


def _require_replaceable(place: Path) -> None:
    """Raise OSError unless a file can be put there."""
    try:
        mode = os.stat(place).st_mode
    except FileNotFoundError:
        return
    if stat.S_ISDIR(mode):
        raise IsADirectoryError(errno.EISDIR, f"{place.name} is a folder")
    if not stat.S_ISREG(mode):
        raise OSError(errno.EINVAL, f"{place.name} is a pipe or a device")
    if not os.access(place, os.W_OK):
        raise PermissionError(errno.EACCES, f"{place.name} is protected")


def _require_none_of(places: Iterable[Path], kept: Iterable[str | Path]) -> None:
    for one in kept:
        for place in places:
            if place.exists() and os.path.exists(one) and os.path.samefile(place, one):
                raise CrossviewError(
                    "this would overwrite what it is made from", str(one), "choose another place"
                )


def _take_mode(made: Path, target: Path) -> None:
    if target.exists():
        made.chmod(stat.S_IMODE(target.stat().st_mode))


def _move(staging: Path, target: Path) -> None:
    """Move all files below `staging` to the same places below `target`; all or none."""
    files = _files(staging)
    for path in files:
        _take_mode(path, target / path.relative_to(staging))
        flush(path)
    if swapped(staging, target):
        return
    for path in sorted(files, key=lambda path: path.suffix == ".json"):  # it tells of the others
        place = Path(os.path.realpath(target / path.relative_to(staging)))
        place.parent.mkdir(parents=True, exist_ok=True)
        path.replace(place)
    for folder in {target / path.relative_to(staging).parent for path in files}:
        flush(folder)


def unwritable(target: Path, error: OSError) -> Unwritable:
    """Return the error that says why nothing is written there."""
    return Unwritable(f"cannot write, {error.strerror or error}", str(target), ELSEWHERE)
