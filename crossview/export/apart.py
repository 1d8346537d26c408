"""A figure drawn by a process of its own, which keeps no window waiting.

The window starts Python with `ARGUMENTS`, sends it what `packed` gives, and hears `outcome`.
"""

from __future__ import annotations

import os
import pickle
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

from crossview.export.figures import render_view
from crossview.view.scene_view import SceneView
from solvers.errors import CrossviewError

# -P: nothing is imported from where the user happens to be
ARGUMENTS = ("-P", "-c", "from crossview.export.apart import main; main()")
"""Of the Python that draws what it is sent."""


def packed(view: SceneView, path: Path, **settings: Any) -> bytes:
    """Return what to send; parameters as of `figures.render_view`."""
    # views of mappings cannot be sent, and what is made of the triangles is large
    plain = replace(view, layers=dict(view.layers), triangles=None)
    return pickle.dumps((plain, os.fspath(path), settings))


def outcome(answer: bytes) -> CrossviewError | None:
    """Return why the figure could not be made, from what the process has answered."""
    failure: CrossviewError | None = pickle.loads(answer)
    return failure


def main() -> None:
    """Draw the figure that comes in, and answer what went wrong, if anything."""
    view, path, settings = pickle.load(sys.stdin.buffer)
    failure = None
    try:
        render_view(view, path, **settings)
    except CrossviewError as error:
        failure = error
    sys.stdout.buffer.write(pickle.dumps(failure))
