"""What is expected of figures is compared by values, bounds and other cases."""

from typing import Any

import pytest

from crossview.studies.expectations import checks, compared_with

OTHERS = {"start": {"crossings": 12, "spread": 0.5}}


@pytest.mark.parametrize(
    ("wanted", "found", "passed", "words"),
    [
        ("valid", "valid", True, "valid"),
        ("valid", "stretched", False, "valid"),
        (True, True, True, "yes"),
        (4, 4, True, "4"),
        (4, None, False, "4"),
        ({"least": 1}, 0, False, "at least 1"),
        ({"most": 1e-10}, 1e-12, True, "at most 1e-10"),
        ({"least": 0.1, "most": 0.5}, 0.6, False, "at least 0.1, at most 0.5"),
        ({"least": 0}, None, False, "at least 0"),
        ({"most": 1}, float("nan"), False, "at most 1"),
    ],
)
def test_a_figure_is_held_against_its_bounds(
    wanted: Any, found: Any, passed: bool, words: str
) -> None:
    [check] = checks({"figure": wanted}, {"figure": found}, {})
    assert (check.passed, check.wanted, check.found is found) == (passed, words, True)


@pytest.mark.parametrize(("crossings", "passed"), [(11, True), (12, False)])
def test_a_figure_is_held_against_that_of_another_case(crossings: int, passed: bool) -> None:
    expect = {"crossings": {"below": "start"}, "spread": {"near": "start", "within": 0.1}}
    assert compared_with(expect) == {"start"}
    fewer, alike = checks(expect, {"crossings": crossings, "spread": 0.59}, OTHERS)
    assert (fewer.passed, alike.passed) == (passed, True)
    assert "that of start" in fewer.wanted
