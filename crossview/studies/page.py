"""The page of a study: what ended how, distributions of figures, the best and the worst."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Sequence
from html import escape
from typing import Any

import numpy as np

from crossview.studies.outcome import DONE
from crossview.studies.table import FIRST, Row, columns

RANKS = ("quads.min_scaled_jacobian", "-energy_final")
"""What tells the best from the worst if the study does not say: the first that there is."""

BINS, SHOWN, MOST_REASONS, MOST_PLOTS = 24, 6, 20, 60
"""Bars of a distribution; rows shown as best and as worst; reasons; distributions. Chosen."""

WIDTH, HEIGHT = 260, 70
"""Pixels of a distribution."""

STYLE = """
body { font: 15px/1.45 system-ui, sans-serif; margin: 2em auto; max-width: 72em; padding: 0 1em; }
table { border-collapse: collapse; } td, th { padding: .2em .8em .2em 0; text-align: left; }
.many { display: flex; flex-wrap: wrap; gap: 1em; } figure { margin: 0; width: 260px; }
figure img { max-width: 100%; } figcaption { font-size: 13px; overflow-wrap: anywhere; }
svg { background: #f2f2f2; } rect { fill: #3b6ea5; }
"""
"""How the page looks."""


def page(rows: Sequence[Row], varied: Sequence[str] = (), rank: str | None = None) -> str:
    """Return the page of a table as HTML.

    Parameters
    ----------
    rows : sequence of dict
        Of the table.
    varied : sequence of str, optional
        The places that vary.
    rank : str, optional
        The figure that tells the best from the worst, largest first, or least first after a minus
        sign.
    """
    body = "\n".join([*_counts(rows), *_best_and_worst(rows, varied, rank), *_distributions(rows)])
    head = f'<meta charset="utf-8"><title>A study of {len(rows)} cases</title>'
    return f"<!doctype html>\n{head}<style>{STYLE}</style>\n{body}\n"


def _counts(rows: Sequence[Row]) -> Iterator[str]:
    """How many ended how, and why not well."""
    yield f"<h1>{len(rows)} cases</h1>"
    ended = Counter(row["status"] for row in rows)
    told = ", ".join(f"{count} {escape(status)}" for status, count in ended.most_common())
    yield f'<p>{told}. All figures are in <a href="table.csv">table.csv</a>.</p>'
    reasons = Counter(
        (row["status"], row["step"], row["reason"]) for row in rows if row["status"] != DONE
    )
    if reasons:
        yield "<h2>Not done</h2><table><tr><th>cases<th>how<th>step<th>why</tr>"
        for words, count in reasons.most_common(MOST_REASONS):
            yield f"<tr><td>{count}" + "".join(f"<td>{escape(word)}" for word in words) + "</tr>"
        yield "</table>"
        if len(reasons) > MOST_REASONS:
            yield f"<p>And {len(reasons) - MOST_REASONS} other reasons.</p>"


def _best_and_worst(rows: Sequence[Row], varied: Sequence[str], rank: str | None) -> Iterator[str]:
    names = columns(rows)
    if rank is None:
        rank = next((name for name in RANKS if name.removeprefix("-") in names), None)
    if rank is None:
        return
    name, sign = rank.removeprefix("-"), -1 if rank.startswith("-") else 1
    ranked = [row for row in rows if row["status"] == DONE and _number(row.get(name)) is not None]
    ranked.sort(key=lambda row: -sign * row[name])
    if not ranked:
        yield f"<p>No case has a number for {escape(name)}, by which cases are ranked.</p>"
        return
    for title, shown in (("Best", ranked[:SHOWN]), ("Worst", ranked[: -SHOWN - 1 : -1])):
        yield f'<h2>{title} by {escape(name)}</h2><div class="many">'
        yield from (_shown(row, name, varied) for row in shown)
        yield "</div>"


def _shown(row: Row, name: str, varied: Sequence[str]) -> str:
    """A case with its picture if it has one."""
    picture = ""
    if row["files"]:
        place = escape(row["files"], quote=True)
        picture = f'<a href="{place}/"><img src="{place}/figure.png" alt=""></a>'
    own = [f"{place} {row[place]}" for place in varied if place in row]
    told = ", ".join([row["case"], *own])
    return f"<figure>{picture}<figcaption>{row[name]:.4g}: {escape(told)}</figcaption></figure>"


def _distributions(rows: Sequence[Row]) -> Iterator[str]:
    """Each figure that is not the same in all cases that are done."""
    yield '<h2>Distributions</h2><div class="many">'
    done = [row for row in rows if row["status"] == DONE]
    plotted = 0
    for name in columns(done):
        if name in FIRST and name != "seconds":
            continue
        numbers = [v for row in done if (v := _number(row.get(name))) is not None]
        if len(set(numbers)) < 2 or plotted == MOST_PLOTS:
            continue
        plotted += 1
        yield _histogram(name, np.array(numbers))
    yield "</div>"


def _histogram(name: str, numbers: np.ndarray[Any, Any]) -> str:
    counts, _ = np.histogram(numbers, bins=BINS)
    wide, tall = WIDTH / BINS, HEIGHT / counts.max()
    bars = "".join(
        f'<rect x="{i * wide:.1f}" y="{HEIGHT - count * tall:.1f}" '
        f'width="{wide - 1:.1f}" height="{count * tall:.1f}"/>'
        for i, count in enumerate(counts)
        if count
    )
    told = f"{numbers.min():.4g}, median {np.median(numbers):.4g}, {numbers.max():.4g}"
    drawn = f'<svg width="{WIDTH}" height="{HEIGHT}" role="img">{bars}</svg>'
    return f"<figure>{drawn}<figcaption><b>{escape(name)}</b><br>{told}</figcaption></figure>"


def _number(value: Any) -> float | None:
    """A finite number, else None."""
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        return None
    return value
