"""The figures of a report, one by one, for a table."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any


def figures(report: Mapping[str, Any]) -> dict[str, Any]:
    """Return the numbers, words and truth values of a report by name.

    Parameters
    ----------
    report : mapping
        As `crossview.report` returns it. Of a list its length (count), and the least and the
        greatest (min, max) of numbers in it or in its objects.

    Examples
    --------
    >>> from crossview.studies.figures import figures
    >>> figures({"quads": {"quads": 5}, "holonomy": [{"turns": 0}, {"turns": 2}]})
    {'quads.quads': 5, 'holonomy.count': 2, 'holonomy.turns.min': 0, 'holonomy.turns.max': 2}
    """
    return dict(_named("", report))


def _named(name: str, value: Any) -> Iterator[tuple[str, Any]]:
    if isinstance(value, Mapping):
        for key, member in value.items():
            yield from _named(f"{name}.{key}" if name else key, member)
    elif isinstance(value, list):
        yield f"{name}.count", len(value)
        yield from _range(name, value)
        if value and isinstance(value[0], Mapping):
            for key in value[0]:
                yield from _range(f"{name}.{key}", [member.get(key) for member in value])
    else:
        yield name, value


def _range(name: str, values: Sequence[Any]) -> Iterator[tuple[str, Any]]:
    numbers = [v for v in values if isinstance(v, int | float) and not isinstance(v, bool)]
    if numbers:
        yield f"{name}.min", min(numbers)
        yield f"{name}.max", max(numbers)
