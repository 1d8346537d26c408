"""What was done in a session, as a Python script that does it again."""

from __future__ import annotations

from pathlib import Path
from pprint import pformat

from crossview.session.state import SessionState


def script(state: SessionState) -> str:
    """Return a script that solves what is open and, where quads are shown, makes as many.

    Surfaces are named from the root, so that it runs in any folder.
    """
    if state.document is None:
        return ""
    case = state.document.to_case()
    root = Path(case.surface).absolute().anchor if isinstance(case.surface, str) else "."
    told = pformat(case.to_json(root), sort_dicts=False)
    lines = [
        "import crossview",
        "",
        f"case = crossview.Case.from_json({told}, {root!r})",
        "problem = crossview.read(case)",
        "solution = crossview.solve(problem)",
        "print(solution.verdict)",
    ]
    quads = state.made.quads
    if quads is not None:
        lines += [
            "layout = crossview.layout(solution)",
            f"mesh = crossview.quads(layout, {len(quads.quads)})",
            'crossview.write_mesh(mesh, "quads.obj")',
        ]
    return "\n".join(lines) + "\n"
