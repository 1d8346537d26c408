"""On a screen of two device pixels per pixel every click and drag hits the same places."""

import os
import subprocess
import sys
from pathlib import Path

from PySide6.QtWidgets import QApplication

STORY = "test_first_minutes.py::test_open_add_drag_undo_redo_delete_export"


def test_the_first_minutes_at_twice_the_resolution(app: QApplication) -> None:
    story = Path(__file__).with_name("test_first_minutes.py")
    run = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", str(story.parent / STORY)],
        cwd=story.parents[2],
        env={**os.environ, "QT_SCALE_FACTOR": "2"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert run.returncode == 0, run.stdout
    assert "1 passed" in run.stdout
