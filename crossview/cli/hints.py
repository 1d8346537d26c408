"""The option or command that carries out a remedy."""

from __future__ import annotations

from crossview.workflow.loading import RepairAndChoose
from solvers.remedies import MakeValid, Remedy, RepairSurface, TakeLargest, UseMethod
from solvers.singularities import AddMissing


def with_command(remedy: Remedy) -> str:
    """Return a remedy in words, with the option or the command that does it if there is one."""
    match remedy:
        case RepairSurface():
            how = "--repair"
        case RepairAndChoose():
            how = "--repair --component largest"
        case TakeLargest():
            how = "--component largest"
        case MakeValid():
            how = "crossview make-valid"
        case UseMethod(method=method):
            how = f"--method {method}"
        case AddMissing(valence=3 | 5):
            how = "crossview complete"
        case _:
            return remedy.words
    return f"{remedy.words} ({how})"
