"""Reader for arrays of numbers in NumPy's .npy files, nothing else that NumPy may find in one."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from crossview.io.regular_file import require_regular

HEADER = re.compile(
    rb"\{\s*'descr':\s*'([<>=|]?[fiu]\d{1,2})',\s*'fortran_order':\s*(True|False),"
    rb"\s*'shape':\s*\(([\d,\s]{0,200})\),?\s*\}\s*"
)
"""What stands before the numbers: their type, order and shape."""


def read_npy(path: Path) -> npt.NDArray[Any]:
    """Return the array of whole or real numbers in a file.

    Raises
    ------
    OSError
        The file cannot be read.
    ValueError
        It is something else, or cut short.
    """
    require_regular(path)
    data = path.read_bytes()
    if data[:6] != b"\x93NUMPY" or data[6:7] not in (b"\1", b"\2", b"\3"):
        raise ValueError("no .npy file")
    first = 10 if data[6] == 1 else 12
    start = first + int.from_bytes(data[8:first], "little")
    header = HEADER.fullmatch(data[first:start])
    if header is None:
        raise ValueError("the .npy file does not hold plain numbers")
    shape = [int(word) for word in header[3].replace(b",", b" ").split()]
    try:
        dtype = np.dtype(header[1].decode())
    except TypeError as error:
        raise ValueError("the .npy file holds an unknown type of numbers") from error
    if len(shape) > 2 or math.prod(shape) * dtype.itemsize > len(data) - start:
        raise ValueError("the .npy file is cut short, or has too many dimensions")
    numbers = np.frombuffer(data, dtype, math.prod(shape), start)
    return numbers.reshape(shape, order="F" if header[2] == b"True" else "C")
