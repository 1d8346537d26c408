"""What stays together where the tests run on several workers, and how Hypothesis draws.

Its examples are the same at each run; `pytest --hypothesis-profile default` draws new ones.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from hypothesis import settings

if TYPE_CHECKING:
    from xdist.remote import Producer
    from xdist.scheduler import LoadScopeScheduling

settings.register_profile("repeatable", derandomize=True, deadline=None, max_examples=30)
settings.load_profile("repeatable")

WINDOWS = ("tests/stories/", "tests/crossview/gui/")


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Producer) -> LoadScopeScheduling:
    """Keep tests of one file on one worker, and all windows on one: they share the focus."""
    from xdist.scheduler import LoadScopeScheduling

    class OneDisplay(LoadScopeScheduling):  # type: ignore[misc] # xdist has no types
        def _split_scope(self, nodeid: str) -> str:
            return "windows" if nodeid.startswith(WINDOWS) else nodeid.partition("::")[0]

    return OneDisplay(config, log)
