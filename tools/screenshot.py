"""Take the README's picture of the window: resources/screenshot.png. Needs a display."""

import sys
import time
from pathlib import Path

from crossview.gui.app import application
from crossview.gui.main_window import MainWindow
from crossview.scene import ensure_rendering

CASE = sys.argv[1] if len(sys.argv) > 1 else "annulus-far"
PICTURE = Path(__file__).parents[1] / "resources" / "screenshot.png"
SIZE, SECONDS = (1280, 800), 4.0

ensure_rendering()
app = application()
window = MainWindow()
window.resize(*SIZE)
window.show()
window.files.open(CASE)
end = time.monotonic() + SECONDS  # solved, and drawn smoothly at rest
while time.monotonic() < end:
    app.processEvents()
    if window.state.solved and window.state.selected is None:
        window.workspace.set(selected=0)
window.grab().save(str(PICTURE))
window.close()
