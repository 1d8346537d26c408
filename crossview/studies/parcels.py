"""The files of a case as bytes: known by their contents, sent to where it is worked on."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cache, lru_cache
from pathlib import Path
from urllib.parse import unquote

from crossview.cases.model import Case
from solvers.errors import CrossviewError


@dataclass(frozen=True)
class Parcel:
    """A file and those that it refers to.

    Parameters
    ----------
    digest : str
        Of the contents.
    name : str
        Of the file itself.
    contents : dict of str to bytes
        By name.
    """

    digest: str
    name: str
    contents: dict[str, bytes]

    def unpack(self, folder: Path) -> Path:
        """Write it below a folder and return where the file is.

        Parameters
        ----------
        folder : Path
            Where it gets a folder of its own.
        """
        own = folder / self.digest
        for name, content in self.contents.items():
            place = own / name
            place.parent.mkdir(parents=True, exist_ok=True)
            place.write_bytes(content)
        return own / self.name


def parcel(file: str) -> Parcel:
    """Pack a file.

    Parameters
    ----------
    file : str
        Its path.

    Raises
    ------
    CrossviewError
        It cannot be read.
    """
    return _parcel(file, _written(file))


def digest(file: str) -> str:
    """Return what the contents of a file are known by.

    Parameters
    ----------
    file : str
        Its path.

    Raises
    ------
    CrossviewError
        It cannot be read.
    """
    return _digest(file, _written(file))


def _written(file: str) -> tuple[int, int]:
    """When a file was written, and its size: while both stay it is not read again."""
    try:
        found = Path(file).stat()
    except OSError as error:
        raise _unreadable(file, error) from error
    return found.st_mtime_ns, found.st_size


@lru_cache(maxsize=4)
def _parcel(file: str, written: tuple[int, int]) -> Parcel:
    path = Path(file)
    try:
        contents = {path.name: path.read_bytes()}
        for name in _buffers(path, contents[path.name]):
            contents[name] = (path.parent / name).read_bytes()
    except OSError as error:
        raise _unreadable(file, error) from error
    known = hashlib.sha256()
    for name, content in contents.items():
        known.update(f"{name} {len(content)} ".encode())
        known.update(content)
    return Parcel(known.hexdigest(), path.name, contents)


@cache
def _digest(file: str, written: tuple[int, int]) -> str:
    return _parcel(file, written).digest


def _unreadable(file: str, error: OSError) -> CrossviewError:
    reason = (error.strerror or str(error)).lower()
    return CrossviewError(f"cannot open the file: {reason}", file)


def with_files(case: Case, places: Mapping[str, str]) -> Case:
    """Return the same case with its files at other places.

    Parameters
    ----------
    case : Case
        What to change.
    places : mapping of str to str
        The other path for each of the case's files.
    """
    if isinstance(case.surface, str):
        case = replace(case, surface=places[case.surface])
    if isinstance(case.options.sizes, str):
        sizes = places[case.options.sizes]
        case = replace(case, options=replace(case.options, sizes=sizes))
    return case


def _buffers(path: Path, content: bytes) -> list[str]:
    """The files beside a glTF file that hold its numbers."""
    if path.suffix.lower() != ".gltf":
        return []
    try:
        buffers = json.loads(content).get("buffers", [])
        names = [unquote(buffer["uri"]) for buffer in buffers if "uri" in buffer]
    except (ValueError, AttributeError, TypeError, KeyError):
        return []  # whoever reads it tells what is wrong
    ways = [Path(name) for name in names if not name.startswith("data:")]
    return [str(way) for way in ways if not way.is_absolute() and ".." not in way.parts]
