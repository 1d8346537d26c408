"""Take the README's picture of the window: resources/screenshot.png. Needs a display."""

import sys
import time
from pathlib import Path
from tempfile import mkdtemp

from PySide6.QtCore import QSettings

from crossview.gui.app import application
from crossview.gui.main_window import MainWindow
from crossview.scene import ensure_rendering

CASE = sys.argv[1] if len(sys.argv) > 1 else "annulus-near"
PICTURE = Path(__file__).parents[1] / "resources" / "screenshot.png"
SIZE, REST, PATIENCE = (1280, 800), 1.5, 60.0

ensure_rendering()
app = application()
# as at first, whatever the user's own panels are
QSettings.setDefaultFormat(QSettings.Format.IniFormat)
QSettings.setPath(QSettings.Format.IniFormat, QSettings.Scope.UserScope, mkdtemp())
window = MainWindow()
window.resize(*SIZE)
window.show()
window.files.open(CASE)
start = rested = time.monotonic()  # until solved, traced, and drawn smoothly at rest
while time.monotonic() < min(rested + REST, start + PATIENCE):
    app.processEvents()
    if window.session.solving.busy or not window.state.solved:
        rested = time.monotonic()
    if window.state.solved and window.state.focus.selected is None:
        window.session.pointer.select(0)
window.grab().save(str(PICTURE))
window.close()
