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


def anisotropic_rows() -> Iterator[str]:
    for n in sorted({n for name, n in MEASURED if name == "anisotropic"}):
        got = {name: value for (name, size), value in MEASURED.items() if size == n}
        yield f"{n} triangles"
        if "laplacian" in got:
            yield f"  SuperLU factorisation of S       {got['laplacian']:8.3f} s"
        for name, label in (("newton", "a Newton step"), ("newton-superlu", "the same by SuperLU")):
            if name in got and "laplacian" in got:
                yield (
                    f"  {label:32} {got[name]:8.3f} s "
                    f"= {got[name] / got['laplacian']:5.2f} factorisations"
                )
        yield f"  aligned and smoothest field      {got['anisotropic']:8.3f} s"
        if "anisotropic-memory" in got:
            yield f"  peak memory                      {got['anisotropic-memory']:8.0f} MB"


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    for title, told in (
        ("the isotropic stage", list(rows())),
        ("the anisotropic stage", list(anisotropic_rows())),
    ):
        if told:
            terminalreporter.section(title)
        for row in told:
            terminalreporter.write_line(row)
