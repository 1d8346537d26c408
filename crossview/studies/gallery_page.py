"""The page of the gallery: pictures, figures, and whether they are as expected."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from html import escape
from typing import Any

from crossview.studies.exhibition import Exhibited
from crossview.studies.expectations import Check

TOLD = {
    "method": "method",
    "index_sum": "index sum",
    "energy_final": "E",
    "layout.t_junctions": "T-junctions",
    "layout.patches": "patches",
    "quads.quads": "quads",
    "quads.min_scaled_jacobian": "least scaled Jacobian",
}
"""Figures that the page tells of every case, whatever is expected, and their words."""

STYLE = """
body { font: 15px/1.5 system-ui, sans-serif; margin: 2em auto; max-width: 76em; padding: 0 1em;
  color: #22262c; background: #fff; }
h2 { margin-top: 2.5em; border-bottom: 1px solid #d8dbe0; } h3 { margin: 1.6em 0 .2em; }
.many { display: flex; flex-wrap: wrap; gap: 1em; margin: .6em 0; } figure { margin: 0; }
figure img { width: 22em; max-width: 100%; height: auto; border: 1px solid #e4e6ea; }
figcaption { font-size: 13px; color: #5c626c; }
table { border-collapse: collapse; font-size: 14px; } td, th { padding: .15em 1em .15em 0;
  text-align: left; font-weight: normal; } th { color: #5c626c; }
.pass { color: #1d7a43; } .fail { color: #c0202c; font-weight: bold; }
code { font-size: 13px; }
"""
"""How the page looks."""


def gallery_page(shown: Sequence[Exhibited]) -> str:
    """Return the page as HTML, with links relative to the folder of the exhibition.

    Parameters
    ----------
    shown : sequence of Exhibited
        What is on it.
    """
    failed = [each for each in shown if not each.passed]
    verdict = '<p class="pass">All is as expected.</p>'
    if failed:
        anchors = (each.exhibit.case for each in failed)
        links = ", ".join(f'<a href="#{name}">{name}</a>' for name in anchors)
        verdict = f'<p class="fail">{len(failed)} of {len(shown)} not as expected: {links}</p>'
    head = '<meta charset="utf-8"><meta name="viewport" content="width=device-width">'
    head += f"<title>Gallery of crossview</title><style>{STYLE}</style>"
    body = "\n".join(_groups(shown))
    return (
        f'<!doctype html>\n<html lang="en"><head>{head}</head>\n<body><h1>Gallery</h1>\n'
        f"{verdict}\n{body}\n</body></html>\n"
    )


def _groups(shown: Sequence[Exhibited]) -> Iterator[str]:
    group = ""
    for each in shown:
        if each.exhibit.group != group:
            group = each.exhibit.group
            yield f"<h2>{escape(group)}</h2>"
        yield from _case(each)


def _case(each: Exhibited) -> Iterator[str]:
    name = each.exhibit.case
    mark = _mark(each.passed)
    yield f'<section id="{name}"><h3>{escape(each.title)} {mark}</h3>'
    yield f"<p>{escape(each.exhibit.sentence)}</p>"
    yield '<div class="many">' + "".join(_picture(name, kind) for kind in each.exhibit.pictures)
    yield "</div>"
    known = {words: each.figures.get(key) for key, words in TOLD.items()}
    told = [f"{words} {_value(value)}" for words, value in known.items() if value is not None]
    yield f"<p>{escape(', '.join(told))}. "
    yield f"<code>{name}</code>: " + ", ".join(
        f'<a href="{name}/{file}">{file}</a>' for file in ("report.json", "case.json")
    )
    yield "</p><table><tr><th>expected of<th>to be<th>is<th></tr>"
    yield from map(_row, each.checks)
    yield "</table></section>"


def _picture(name: str, kind: str) -> str:
    place = f"{name}/{kind}"
    image = f'<img src="{place}.png" alt="{kind} of {name}" loading="lazy">'
    paper = f'<a href="{place}.pdf">PDF</a>'
    caption = f"<figcaption>{kind}, {paper}</figcaption>"
    return f'<figure><a href="{place}.png">{image}</a>{caption}</figure>'


def _row(check: Check) -> str:
    found = "none" if check.found is None else _value(check.found)
    cells = "".join(f"<td>{escape(cell)}" for cell in (check.figure, check.wanted, found))
    return f"<tr>{cells}<td>{_mark(check.passed)}</tr>"


def _mark(passed: bool) -> str:
    return '<span class="pass">pass</span>' if passed else '<span class="fail">FAIL</span>'


def _value(value: Any) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    return f"{value:.4g}" if isinstance(value, float) else str(value)
