"""Files that are read whole: no devices, pipes or folders, whatever their names say."""

from __future__ import annotations

import codecs
import errno
import os
import stat
from pathlib import Path

from solvers.errors import CrossviewError


def require_regular(path: str | Path) -> int:
    """Return the size in bytes of a file that ends.

    Parameters
    ----------
    path : path
        Links are followed.

    Raises
    ------
    OSError
        There is no such file, or it is a folder.
    CrossviewError
        It is a pipe, a device or a socket: reading it may never end.
    """
    found = os.stat(path)
    if stat.S_ISDIR(found.st_mode):
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
    if not stat.S_ISREG(found.st_mode):
        raise CrossviewError("not a file but a pipe or a device", str(path), "name a file")
    return found.st_size


def unmarked(data: bytes) -> bytes:
    r"""Return a text without the byte order mark that some editors begin it with.

    A text in UTF-16, which is told by its mark, becomes one in UTF-8.

    Parameters
    ----------
    data : bytes
        What is in the file.

    Raises
    ------
    UnicodeDecodeError
        A mark of UTF-16 stands before something else.

    Examples
    --------
    >>> from crossview.io.regular_file import unmarked
    >>> unmarked(b"\xef\xbb\xbfv 0 0 0")
    b'v 0 0 0'
    """
    if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return data.decode("utf-16").encode()
    return data.removeprefix(codecs.BOM_UTF8)
