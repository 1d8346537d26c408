"""The words of a text file, line by line, found without a call for each line."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from solvers.surface import FloatArray, IntArray

LONGEST = 100
"""Characters of the longest word that is taken: all words get the room of the longest. Chosen."""

SPACES = np.isin(np.arange(256), list(b" \t\n\r\x0b\x0c"))
"""Which bytes part words, as `bytes.split` has it."""


@dataclass(frozen=True, eq=False)
class Words:
    """Words and the lines they stand in.

    Parameters
    ----------
    text : (w,) bytes array
        The words.
    first : (l,) int array
        The first word of each line that has any.
    count : (l,) int array
        How many words it has.
    """

    text: npt.NDArray[np.bytes_]
    first: IntArray
    count: IntArray

    @classmethod
    def of(cls, data: bytes, slashed: bytes = b"") -> Words:
        """Find the words of a text without comments.

        Parameters
        ----------
        data : bytes
            The text.
        slashed : bytes, optional
            In lines that begin with this letter, what follows a slash in a word is left out.

        Raises
        ------
        ValueError
            If a word is longer than any number.
        """
        data = data.replace(b"\r", b"\n").replace(b"\\\n", b"  ")  # such a line goes on
        chars = np.frombuffer(data, dtype=np.uint8).copy()
        newline = chars == ord("\n")
        _blank(chars, chars == ord("#"), newline)
        if slashed:
            kind = np.zeros(np.count_nonzero(newline) + 1, dtype=np.uint8)
            begins, line = _begins(chars, newline)
            kind[line[::-1]] = chars[begins[::-1]]  # the first of a line is written last
            slash = np.flatnonzero(chars == ord("/"))
            in_line = np.searchsorted(np.flatnonzero(newline), slash)
            marks = np.zeros(len(chars), dtype=bool)
            marks[slash[kind[in_line] == slashed[0]]] = True
            _blank(chars, marks, SPACES[chars])
        begins, line = _begins(chars, newline)
        space = np.append(SPACES[chars], True)
        if len(begins) and (np.flatnonzero(~space[:-1] & space[1:]) - begins).max() >= LONGEST:
            raise ValueError
        first = np.flatnonzero(np.diff(line, prepend=-1))
        count = np.diff(np.append(first, len(begins)))
        return cls(np.array(chars.tobytes().split(), dtype="S"), first, count)

    def starting(self, word: bytes) -> IntArray:
        """Return the lines that begin with a word."""
        return np.flatnonzero(self.text[self.first] == word)

    def numbers(self, lines: IntArray, skipped: int, count: int) -> FloatArray:
        """Return the first numbers (k, count) of lines, after some words.

        Raises
        ------
        ValueError
            If there are not so many, or they are none.
        """
        if (self.count[lines] < skipped + count).any():
            raise ValueError
        at = self.first[lines][:, None] + skipped + np.arange(count)
        return np.asarray(self.text[at].astype(np.float64))

    def whole_numbers(self, lines: IntArray, skipped: int, count: IntArray) -> IntArray:
        """Return the first whole numbers of lines one after the other, so many of each.

        Raises
        ------
        ValueError
            As of `numbers`.
        """
        if (count < 0).any() or (self.count[lines] < skipped + count).any():
            raise ValueError
        at = np.repeat(self.first[lines] + skipped - (np.cumsum(count) - count), count)
        return np.asarray(self.text[at + np.arange(len(at))].astype(np.int64))


def _begins(
    chars: npt.NDArray[np.uint8], newline: npt.NDArray[np.bool_]
) -> tuple[IntArray, IntArray]:
    """Return where words begin, and in which lines."""
    space = SPACES[chars]
    begins = np.flatnonzero(~space & np.append(True, space[:-1])[: len(space)])
    return begins, np.searchsorted(np.flatnonzero(newline), begins)


def _blank(
    chars: npt.NDArray[np.uint8], marks: npt.NDArray[np.bool_], ends: npt.NDArray[np.bool_]
) -> None:
    """Put spaces from each mark to the next end."""
    if not marks.any():
        return
    place = np.arange(len(chars), dtype=np.int64)
    last_mark = np.maximum.accumulate(np.where(marks, place, -1))
    last_end = np.maximum.accumulate(np.where(ends, place, -1))
    chars[last_mark > last_end] = ord(" ")
