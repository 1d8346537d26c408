"""Run the examples of a document, as its reader would: one after the other, in one folder.

A block of Python runs in a namespace that it shares with the others of its document. A block of sh
runs the `crossview` commands in it, but for those that open the window. A block of JSON is a case;
a name after ``json`` is the file that the reader keeps it in. What a block prints is said by the
comments beside its `print` calls, or by a block of text that follows at once.
"""

from __future__ import annotations

import contextlib
import io
import json
import re
import shlex
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import zip_longest
from pathlib import Path
from typing import Any

from crossview.cases.model import Case
from crossview.cli import app, main
from crossview.studies import Study

FENCE = re.compile(r"^```(?P<info>\w[^\n]*)\n(?P<text>.*?)^```$", re.MULTILINE | re.DOTALL)
SAID = re.compile(r"^ *print\(.*\) *# (.*)$", re.MULTILINE)
LANGUAGES = ("python", "sh", "json")


@dataclass(frozen=True)
class Example:
    """A block of code in a document.

    Parameters
    ----------
    language : {"python", "sh", "json"}
    name : str
        Of the file that a block of JSON is kept in; empty for none.
    line : int
        Where it starts in the document.
    text : str
    printed : str or None
        What the block of text behind it says that it prints.
    """

    language: str
    name: str
    line: int
    text: str
    printed: str | None


class WrongExample(Exception):
    """An example does something else than its document says."""


def examples(text: str) -> Iterator[Example]:
    """The examples of a document, in their order."""
    blocks = list(FENCE.finditer(text))
    for block, after in zip_longest(blocks, blocks[1:]):
        language, _, name = block["info"].partition(" ")
        if language not in LANGUAGES:
            continue
        printed = None
        if after is not None and after["info"] == "text":
            follows = not text[block.end() : after.start()].strip()
            printed = after["text"] if follows else None
        yield Example(
            language, name, text.count("\n", 0, block.start()) + 1, block["text"], printed
        )


def run_examples(document: Path, folder: Path) -> None:
    """Run a document's examples in a folder.

    Raises
    ------
    WrongExample
        One prints something else than is said, or a command fails.
    """
    namespace: dict[str, Any] = {}
    found = list(examples(document.read_text(encoding="utf-8")))
    with contextlib.chdir(folder):
        for example in found:
            place = f"{document.name}, line {example.line}"
            with contextlib.redirect_stdout(io.StringIO()) as stream:
                _run(example, place, namespace)
            printed = stream.getvalue()
            if example.printed is not None and printed != example.printed:
                raise WrongExample(f"{place} prints\n{printed}\nand not\n{example.printed}")
            if example.printed is None and example.language == "python":
                _compare(printed.splitlines(), SAID.findall(example.text), place)


def _run(example: Example, place: str, namespace: dict[str, Any]) -> None:
    if example.language == "python":
        # blank lines before it, so that a traceback tells the document's line
        exec(compile("\n" * example.line + example.text, place, "exec"), namespace)
    elif example.language == "json":
        data = json.loads(example.text)
        (Study if "cases" in data else Case).from_json(data)
        if example.name:
            Path(example.name).write_text(example.text, encoding="utf-8")
    else:
        for line in example.text.replace("\\\n", " ").splitlines():
            words = shlex.split(line, comments=True)
            if words[:1] == ["crossview"] and words[1:2] and words[1] in app and main(words[1:]):
                raise WrongExample(f"{place}: {line} fails")


def _compare(printed: list[str], said: list[str], place: str) -> None:
    """Compare lines with comments, which may go on after a colon."""
    same = len(printed) == len(said) and all(
        comment == line or comment.startswith(f"{line}: ")
        for line, comment in zip(printed, said, strict=True)
    )
    if not same:
        raise WrongExample(f"{place} prints {printed} and not {said}")
