"""Numbers and words as the window shows them."""

import pytest

from crossview.view.texts import count, degrees, position, signed


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (degrees(0.0), "0°"),
        (degrees(-12.04), "−12.0°"),
        (degrees(0.314), "0.31°"),
        (degrees(0.0123), "0.012°"),
        (signed(0), "0"),
        (signed(2), "+2"),
        (signed(-1), "−1"),
        (count(1, "vertex", "vertices"), "1 vertex"),
        (count(2304, "vertex", "vertices"), "2\u2009304 vertices"),
        (position((0.5, -0.25, 0.0), 2.0), "0.50, −0.25, 0.00"),
        (position((0.0, 1e-9, 0.0), 2.0), "0.00, 0.00, 0.00"),  # the middle, as exact as the rest
    ],
)
def test_numbers_have_sensible_digits(text: str, expected: str) -> None:
    assert text == expected
