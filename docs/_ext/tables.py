"""What the program says of itself, as Markdown: actions, commands, the numbers of its gallery."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable
from pathlib import Path

from crossview.cases.gallery import names
from crossview.cli import app as command_line
from crossview.gui.action_table import ACTIONS


def actions() -> str:
    """The window's actions, a table for each menu."""
    said = []
    for menu in dict.fromkeys(action.menu for action in ACTIONS):
        rows = [
            (
                f"{action.submenu} › {action.text}" if action.submenu else action.text,
                " ".join(f"{{kbd}}`{key}`" for key in action.keys),
                action.tip,
            )
            for action in ACTIONS
            if action.menu == menu
        ]
        said += [f"## {menu}", *table(("action", "keys", "what it does"), rows), ""]
    return "\n".join(said)


def commands() -> str:
    """The commands as they describe themselves."""
    text = command_line.generate_docs(output_format="markdown", usage_name="crossview")
    _, _, text = text.partition("\n")  # its title
    text = re.sub(r"## Table of Contents\n.*?(?=\*\*Commands)", "", text, flags=re.DOTALL)
    text = text.replace(" -m sphinx", "")  # which runs the program just now
    return text.replace(" *[default: False]*", "").replace("```console", "```text")


def numbers(folder: Path) -> str:
    """What the gallery's reports say, in the order of the names."""
    rows = []
    for name in names():
        report = json.loads((folder / name / "report.json").read_text(encoding="utf-8"))
        defects = [abs(c["defect_degrees"]) for c in report["holonomy"]]
        quads = report.get("quads")
        rows.append(
            (
                f"`{name}`",
                report["method"],
                f"{max(defects, default=0):.2g}°" if defects else "none",
                "" if report["method"] == "isotropic" else f"{report['energy_final']:.1e}",
                str(report["layout"]["t_junctions"]),
                report["verdict"],
                "" if quads is None else f"{quads['quads']} in {quads['patches']} patches",
            )
        )
    head = ("case", "method", "largest defect", "E", "T-junctions", "verdict", "quads")
    return "\n".join(table(head, rows))


def table(head: Iterable[str], rows: Iterable[Iterable[str]]) -> list[str]:
    """A table as lines of Markdown."""
    head = list(head)
    lines = [head, ["---"] * len(head), *rows]
    return ["| " + " | ".join(cell.replace("|", r"\|") for cell in line) + " |" for line in lines]
