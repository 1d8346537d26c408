"""The command line: the window, and what it does as commands for scripts and tests."""

from __future__ import annotations

import ast
import os
import sys
from collections.abc import Sequence
from pathlib import Path

from cyclopts import App, CycloptsError

from crossview import __version__
from crossview.cli.terminal import complain
from crossview.cli.window import window
from solvers.errors import CrossviewError

__all__ = ["app", "main"]

app = App(
    name="crossview",
    version=__version__,
    help_format="markdown",
    suppress_keyboard_interrupt=False,
)
app.default(window)


def _told(module: str, name: str) -> str:
    """What a command says of itself before its options, without an import of what it needs."""
    source = Path(__file__).with_name(f"{module}.py").read_text(encoding="utf-8")
    functions = (node for node in ast.parse(source).body if isinstance(node, ast.FunctionDef))
    text = next(ast.get_docstring(node) or "" for node in functions if node.name == name)
    return text.partition("\n\nParameters\n")[0]


for module, name in (
    ("info", "info"),
    ("solve", "solve"),
    ("check", "check"),
    ("render", "render"),
    ("animate", "animate"),
    ("gallery", "gallery"),
    ("natural", "natural"),
    ("complete", "complete"),
    ("make_valid", "make_valid"),
    ("improve", "improve"),
    ("snap", "snap"),
    ("simplify", "simplify"),
    ("batch", "batch"),
    ("schema", "schema"),
):
    app.command(f"crossview.cli.{module}:{name}", help=_told(module, name))


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line.

    Parameters
    ----------
    arguments : sequence of str, optional
        Instead of those of the process.

    Returns
    -------
    int
        Exit status: 0 (or the window's, or what `info` says), 1 for quads that are not
        right or a gallery that is not as expected, 2
        for a mistake the user can mend, 130 when interrupted.
    """
    tokens = list(sys.argv[1:] if arguments is None else arguments)
    try:
        status: int | None = app(
            tokens, exit_on_error=False, print_error=False, result_action="return_value"
        )
    except CycloptsError as error:
        return _refuse(_usage_error(tokens, error))
    except CrossviewError as error:
        return _refuse(error)
    except OSError as error:  # files say themselves what is wrong with them
        return _refuse(CrossviewError("cannot write the results", "", error.strerror or str(error)))
    except MemoryError:
        return _refuse(CrossviewError("out of memory", "", "use a coarser surface"))
    except KeyboardInterrupt:
        complain("crossview: interrupted")
        return 130
    return status or 0


def _refuse(error: CrossviewError) -> int:
    from crossview.cli.hints import with_command  # it knows of remedies of all rooms

    complain(f"crossview: error: {error.line(with_command)}")
    return 2


def _usage_error(tokens: list[str], error: CycloptsError) -> CrossviewError:
    """What is wrong with the command line."""
    from crossview.cases.json_values import nearest

    what = " ".join(str(error).split()).rstrip(".")
    known = [name for name in app if not name.startswith("-")]
    command = tokens[0]
    if command in known:
        return CrossviewError(what, "", f"see crossview {command} --help")
    if not command.startswith("-") and not os.path.exists(command):
        return CrossviewError(f'unknown command "{command}"', "", nearest(command, known))
    return CrossviewError(what, "", "see crossview --help")
