"""What is expected of the figures of a case, and whether they are so."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

Figures = Mapping[str, Any]
"""Of a case, by name."""


@dataclass(frozen=True)
class Check:
    """One expectation and what came of it.

    Parameters
    ----------
    figure : str
        Its name.
    wanted : str
        What it must be, in words.
    found : object
        What it is; None where there is none.
    passed : bool
    """

    figure: str
    wanted: str
    found: Any
    passed: bool


def compared_with(expect: Figures) -> set[str]:
    """Return the names of the cases that expectations compare with."""
    bounds = [wanted for wanted in expect.values() if isinstance(wanted, Mapping)]
    return {bound[key] for bound in bounds for key in ("below", "near") if key in bound}


def checks(expect: Figures, found: Figures, others: Mapping[str, Figures]) -> Iterator[Check]:
    """Compare figures with what is expected.

    Parameters
    ----------
    expect : mapping of str to object
        As of an `Exhibit`.
    found : mapping of str to object
        The figures.
    others : mapping of str to mapping
        The figures of the cases that are compared with.

    Examples
    --------
    >>> from crossview.studies.expectations import checks
    >>> [check] = checks({"patches": {"most": 5}}, {"patches": 6}, {})
    >>> check.wanted, check.passed
    ('at most 5', False)
    """
    for name, wanted in expect.items():
        value = found.get(name)
        if not isinstance(wanted, Mapping):
            yield Check(name, _word(wanted), value, value == wanted)
            continue
        low, high, words = _bounds(name, wanted, others)
        within = isinstance(value, int | float) and low <= value <= high
        yield Check(name, words, value, within)


def _bounds(
    name: str, wanted: Mapping[str, Any], others: Mapping[str, Figures]
) -> tuple[float, float, str]:
    """The least and the greatest that a figure may be, and both in words."""
    if "below" in wanted:
        other = others[wanted["below"]][name]
        return float("-inf"), other - 1, f"below {_word(other)}, that of {wanted['below']}"
    if "near" in wanted:
        other, within = others[wanted["near"]][name], wanted["within"]
        words = f"within {within:g} of {_word(other)}, that of {wanted['near']}"
        return other - within, other + within, words
    parts = [f"at {end} {_word(wanted[end])}" for end in ("least", "most") if end in wanted]
    return wanted.get("least", float("-inf")), wanted.get("most", float("inf")), ", ".join(parts)


def _word(value: Any) -> str:
    """A value as a reader takes it in at once."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    return f"{value:.6g}" if isinstance(value, float) else str(value)
