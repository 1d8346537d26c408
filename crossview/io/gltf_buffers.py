"""The numbers of a glTF scene: buffers, views of them and accessors, each checked for its size."""

from __future__ import annotations

import base64
from pathlib import Path
from typing import Any
from urllib.parse import unquote

import numpy as np
import numpy.typing as npt

from crossview.io.regular_file import require_regular
from solvers.errors import CrossviewError
from solvers.number_checks import EXACT
from solvers.surface import FloatArray, IntArray

COMPONENTS = {5120: "i1", 5121: "u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
"""NumPy's type for each code of glTF."""


def whole(value: Any) -> int:
    """Return a whole number from 0, or raise ValueError."""
    if isinstance(value, float) and value.is_integer():
        value = int(value)
    if not isinstance(value, int) or isinstance(value, bool) or not 0 <= value <= EXACT:
        raise ValueError("a number is not a whole one from 0")
    return value


def item(values: Any, number: Any) -> Any:
    """Return a numbered object of a list, or raise ValueError."""
    number = whole(number)
    if not isinstance(values, list) or number >= len(values):
        raise ValueError(f"it names object {number} of a list of fewer")
    if not isinstance(values[number], dict):
        raise ValueError("a list holds something else than objects")
    return values[number]


class Buffers:
    """What the accessors of a scene give.

    Parameters
    ----------
    document : dict
        The scene.
    chunk : bytes or None
        The binary part of a GLB file.
    path : Path
        The file; others are read only below its folder.
    """

    def __init__(self, document: dict[str, Any], chunk: bytes | None, path: Path) -> None:
        self._document = document
        self._chunk = chunk
        self._path = path
        self._read: dict[int, bytes] = {}

    def points(self, number: Any) -> FloatArray:
        """Return an accessor of positions (n, 3)."""
        accessor = item(self._document["accessors"], number)
        if accessor["type"] != "VEC3":
            raise ValueError("positions are not of the type VEC3")
        values = self._values(accessor, 3)
        found: FloatArray = values.astype(np.float64)
        if accessor.get("normalized") and values.dtype.kind in "iu":
            found = np.maximum(found / np.iinfo(values.dtype).max, -1.0)
        return found

    def indices(self, number: Any) -> IntArray:
        """Return an accessor of indices (n,)."""
        accessor = item(self._document["accessors"], number)
        if accessor["type"] != "SCALAR":
            raise ValueError("indices are not of the type SCALAR")
        return self._whole(self._values(accessor, 1).reshape(-1))

    def _whole(self, values: npt.NDArray[Any]) -> IntArray:
        if values.dtype.kind != "u":
            raise ValueError("indices are not of an unsigned type")
        return values.astype(np.int64)

    def _values(self, accessor: dict[str, Any], width: int) -> npt.NDArray[Any]:
        """Return the (n, width) numbers of an accessor, with those it replaces (sparse)."""
        count = whole(accessor["count"])
        if "bufferView" in accessor:
            values = self._rows(accessor, accessor["componentType"], count, width)
        else:
            # all 0; something must stand for so many
            if count > self._path.stat().st_size:
                raise ValueError("an accessor is larger than the file")
            values = np.zeros((count, width), COMPONENTS[accessor["componentType"]])
        if "sparse" in accessor:
            sparse = accessor["sparse"]
            n, at, new = whole(sparse["count"]), sparse["indices"], sparse["values"]
            place = self._whole(self._rows(at, at["componentType"], n, 1).reshape(-1))
            if place.size and place.max() >= count:
                raise ValueError("an accessor replaces numbers that it does not have")
            values = values.copy()
            values[place] = self._rows(new, accessor["componentType"], n, width)
        return values

    def _rows(self, source: dict[str, Any], kind: Any, count: int, width: int) -> npt.NDArray[Any]:
        """Return (count, width) numbers of a type that begin in a view of a buffer."""
        view = item(self._document["bufferViews"], source["bufferView"])
        dtype = np.dtype(COMPONENTS[kind])
        data = self._buffer(whole(view["buffer"]))
        first = whole(view.get("byteOffset", 0))
        end = first + whole(view["byteLength"])
        place = first + whole(source.get("byteOffset", 0))
        stride = whole(view.get("byteStride", 0)) or dtype.itemsize * width
        if stride < dtype.itemsize * width:
            raise ValueError("the elements of an accessor overlap")
        last = place + (count - 1) * stride + dtype.itemsize * width
        if end > len(data) or (count and last > end):
            raise ValueError("an accessor reaches beyond its buffer")
        if not count:
            return np.empty((0, width), dtype)
        return np.ndarray((count, width), dtype, data, place, (stride, dtype.itemsize))

    def _buffer(self, number: int) -> bytes:
        """Return a buffer, read once."""
        if number not in self._read:
            buffer = item(self._document["buffers"], number)
            data = self._bytes(buffer.get("uri"), number)
            if whole(buffer["byteLength"]) > len(data):
                raise ValueError("a buffer is cut short")
            self._read[number] = data
        return self._read[number]

    def _bytes(self, uri: Any, number: int) -> bytes:
        if uri is None:
            if number or self._chunk is None:
                raise ValueError("a buffer is missing")
            return self._chunk
        if not isinstance(uri, str):
            raise ValueError("the URI of a buffer is no text")
        if uri[:5].lower() == "data:":
            head, _, data = uri.partition(",")
            if head.endswith(";base64"):
                return base64.b64decode(unquote(data), validate=True)
            raise ValueError("a buffer is not in base64")
        folder = self._path.resolve().parent
        name = unquote(uri)
        parts = name.replace("\\", "/").split("/")
        stays = ".." not in parts and not {"\0", ":"}.intersection(name)
        place = (folder / name).resolve() if stays else folder
        if folder not in place.parents:
            raise CrossviewError(
                "the scene names a buffer outside its folder",
                f"{self._path}, {uri}",
                "move it there",
            )
        try:
            require_regular(place)
            return place.read_bytes()
        except OSError as error:
            reason = (error.strerror or str(error)).lower()
            raise CrossviewError(
                f"cannot open a buffer of the scene: {reason}", f"{self._path}, {uri}"
            ) from error
