"""What one case may take."""

from __future__ import annotations

from dataclasses import dataclass

from solvers.number_checks import real_number

TIME_LIMIT = 600.0
"""Seconds that a case may take if nothing else is said. Chosen."""


@dataclass(frozen=True)
class Limits:
    """What one case may take.

    Parameters
    ----------
    seconds : float
        By the clock, from when a process begins with it.
    gigabytes : float, optional
        Of memory that the process may hold, in 1e9 bytes; None: as much as there is.

    Raises
    ------
    CrossviewError
        One is not above 0.
    """

    seconds: float = TIME_LIMIT
    gigabytes: float | None = None

    def __post_init__(self) -> None:
        real_number("the time limit", self.seconds, above=0)
        if self.gigabytes is not None:
            real_number("the memory limit", self.gigabytes, above=0)
