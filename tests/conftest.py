"""Fixtures that every room's tests share."""

import os
from collections.abc import Callable
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
REAL_SURFACES = Path(os.environ.get("CROSSVIEW_DATA", ROOT.parent / "shared" / "data"))


@pytest.fixture
def real_surface() -> Callable[[str], Path]:
    """The path of a real surface by its file name; skips the test where the folder is missing."""

    def path(name: str) -> Path:
        if not (REAL_SURFACES / name).is_file():
            pytest.skip(f"no real surfaces in {REAL_SURFACES} (set CROSSVIEW_DATA)")
        return REAL_SURFACES / name

    return path
