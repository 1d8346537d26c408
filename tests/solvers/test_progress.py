"""Computations that report: driven to their end, and run as part of others."""

from collections.abc import Generator

import pytest

from solvers.progress import Progress, relayed, run


def counting(n: int) -> Generator[Progress, None, str]:
    for i in range(n):
        yield Progress("counting", i / n)
    return "done"


def test_a_computation_is_run_to_its_result() -> None:
    seen: list[Progress] = []
    assert run(counting(4), seen.append) == "done"
    assert [step.fraction for step in seen] == [0, 0.25, 0.5, 0.75]


def test_relayed_steps_are_shown_in_another_way_or_not_at_all() -> None:
    def show(step: Progress) -> Progress | None:
        return Progress("late", step.fraction) if step.fraction >= 0.5 else None

    seen: list[Progress] = []
    assert run(relayed(counting(4), show), seen.append) == "done"
    assert seen == [Progress("late", 0.5), Progress("late", 0.75)]


def test_an_error_of_a_relayed_computation_comes_through() -> None:
    def failing() -> Generator[Progress, None, None]:
        yield Progress("begun", 0.0)
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        run(relayed(failing(), lambda step: step))
