"""Ratios of what the benchmarks measured, told at the end: seconds vary, ratios carry over."""

from collections.abc import Iterator

import pytest

MEASURED: dict[tuple[str, int], float] = {}


@pytest.fixture
def measured() -> dict[tuple[str, int], float]:
    """Seconds (or megabytes) by what was measured and the number of vertices."""
    return MEASURED


def rows() -> Iterator[str]:
    for n in sorted({n for name, n in MEASURED if name == "edit"}):
        got = {name: value for (name, size), value in MEASURED.items() if size == n}
        yield f"{n} vertices"
        yield f"  SuperLU factorisation            {got['factor']:8.3f} s"
        yield f"  SuperLU back-substitution        {1e3 * got['solve']:8.1f} ms"
        yield (
            f"  arrays to H and theta            {got['total']:8.3f} s "
            f"= {got['total'] / got['factor']:5.2f} factorisations"
        )
        yield (
            f"  an edit: new H and theta         {1e3 * got['edit']:8.1f} ms "
            f"= {got['edit'] / got['solve']:5.2f} back-substitutions"
        )
        yield f"  peak memory                      {got['memory']:8.0f} MB"


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    if MEASURED:
        terminalreporter.section("the isotropic stage")
        for row in rows():
            terminalreporter.write_line(row)
