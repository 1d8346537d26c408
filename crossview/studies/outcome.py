"""What came of one case."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

DONE, FAILED, REFUSED = "done", "failed", "refused"
"""All steps were taken; one of them could not be; the case cannot be begun."""

TIMED_OUT, OUT_OF_MEMORY, DIED = "timed out", "out of memory", "died"
"""The time limit or the memory limit was reached; the process ended by itself."""


@dataclass(frozen=True)
class Outcome:
    """What came of one case.

    Parameters
    ----------
    status : str
        One of the six words of this module.
    reason : str, optional
        Why it is not done, in one line.
    step : str, optional
        The step that it happened in.
    seconds : float, optional
        How long it took by the clock.
    figures : mapping of str to object, optional
        Numbers and words by name.
    files : mapping of str to bytes, optional
        What is kept, by name.
    """

    status: str
    reason: str = ""
    step: str = ""
    seconds: float = 0.0
    figures: Mapping[str, Any] = field(default_factory=dict)
    files: Mapping[str, bytes] = field(default_factory=dict)
