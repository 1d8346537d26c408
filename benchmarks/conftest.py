"""What the benchmarks measured as one table at the end: now, goal, met."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import pytest

Measured = dict[tuple[str, int], float]
MEASURED: Measured = {}


@pytest.fixture
def measured() -> Measured:
    """Seconds (or megabytes) by what was measured and its size."""
    return MEASURED


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--large", action="store_true", help="a million vertices, 500 000 quads too")


def pytest_configure(config: pytest.Config) -> None:
    config.addinivalue_line("markers", "large: takes minutes, measured with --large alone")


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    if not config.getoption("--large"):
        for item in items:
            if item.get_closest_marker("large"):
                item.add_marker(pytest.mark.skip(reason="measured with --large"))


@dataclass(frozen=True)
class Goal:
    """A row: what was measured, in which unit (a measure of the same size, or seconds), and how
    little of it is wanted.
    """

    label: str
    measure: str
    size: int
    most: float
    unit: str = "seconds"

    def row(self, measured: Measured) -> str:
        value = measured[self.measure, self.size]
        if self.unit in UNITS:
            unit, scale = UNITS[self.unit], 1.0
        else:
            unit, scale = self.unit, measured[self.unit, self.size]
        now = value / scale
        met = "yes" if now <= self.most else "no"
        return f"{self.label:48} {now:9.3g} {self.most:9.3g}  {met:4} {NAMES.get(unit, unit)}"


UNITS = {"seconds": "s", "CPU": "CPU s", "memory": "MB"}
NAMES = {
    "factor": "factorisations",
    "laplacian": "factorisations",
    "solve": "back-substitutions",
}

GOALS = (
    *(
        Goal(f"isotropic, arrays to H and theta, {n:,} vertices", "total", n, most, "factor")
        for n, most in ((10_000, 0.8), (100_000, 0.4), (1_000_000, 0.25))
    ),
    *(
        Goal(f"an edit, new H and theta, {n:,} vertices", "edit", n, most, "solve")
        for n, most in ((10_000, 2.0), (100_000, 1.3), (1_000_000, 1.2))
    ),
    Goal("memory of a solve, 1,000,000 vertices", "memory", 1_000_000, 1500, "memory"),
    Goal("a Newton step, 100,000 triangles", "newton", 100_000, 2.5, "laplacian"),
    Goal("the same by SuperLU alone", "newton-superlu", 100_000, 20, "laplacian"),
    Goal("aligned and smoothest field, 12,000 triangles", "anisotropic", 12_000, 2.0),
    Goal("memory of it, 100,000 triangles", "anisotropic-memory", 100_000, 4000, "memory"),
    Goal("natural, MBO, 41,000 vertices", "mbo", 41_000, 3.0),
    Goal("natural, Ginzburg-Landau, 41,000 vertices", "ginzburg-landau", 41_000, 3.0),
    Goal("natural, globally optimal, 41,000 vertices", "globally-optimal", 41_000, 2.2),
    Goal("layout, 400,000 triangles", "layout", 400_000, 1.5, "factor"),
    Goal("50,000 quads from a layout, not smoothed", "quads", 50_000, 1.0),
    Goal("500,000 quads from a layout, not smoothed", "quads", 500_000, 8.0),
    Goal("crossview --help", "help", 0, 0.15, "CPU"),
    Goal("crossview solve disk-4", "solve", 0, 0.7, "CPU"),
    Goal("crossview render disk-4", "render", 0, 1.5, "CPU"),
    Goal("memory of render disk-4", "render-memory", 0, 300, "memory"),
)


def rows(measured: Measured) -> Iterator[str]:
    """One row for each goal whose figures are there, and how many are met."""
    got = []
    for goal in GOALS:
        needed = [goal.measure] + ([] if goal.unit in UNITS else [goal.unit])
        if all(math.isfinite(measured.get((m, goal.size), math.nan)) for m in needed):
            got.append(goal.row(measured))
    if got:
        yield f"{'work':48} {'now':>9} {'goal':>9}  met  unit"
        yield from got
        yield "Factorisations and back-substitutions are SuperLU's, of the same surface's Laplacian"


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    told = list(rows(MEASURED))
    if told:
        terminalreporter.section("now and goal")
    for row in told:
        terminalreporter.write_line(row)
