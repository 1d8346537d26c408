"""Take pictures of the window in twelve situations, and put them on one sheet. Needs a display.

usage: python -m tools.screenshots [FOLDER [SITUATION...]], by default build/screenshots and all
       python -m tools.screenshots readme, the README's picture: resources/screenshot.png
"""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory

from PySide6.QtCore import QSettings, Qt
from PySide6.QtGui import QImage, QPainter
from PySide6.QtWidgets import QDialog

from crossview.gui.app import application
from crossview.gui.main_window import MainWindow
from crossview.scene import ensure_rendering

ROOT = Path(__file__).parents[1]
SMALL, LARGE = (1280, 800), (1920, 1080)
REST, PATIENCE = 1.0, 120.0
COLUMNS, CELL, GAP = 3, (960, 600), 16


@dataclass(frozen=True)
class Situation:
    """A window as it is shown.

    Parameters
    ----------
    case : str or None
        What is opened.
    actions : tuple of str
        Actions that are triggered, one after the other, each until all is at rest.
    layers : tuple of str
        Layers, hidden at first, that are shown at last.
    size : (int, int)
        Of the window, in points.
    theme : str
        "light" or "dark".
    scale : int
        Pixels per point.
    selected : int or None
        The singularity that is selected.
    """

    case: str | None
    actions: tuple[str, ...] = ()
    layers: tuple[str, ...] = ()
    size: tuple[int, int] = SMALL
    theme: str = "light"
    scale: int = 1
    selected: int | None = None


README = Situation("annulus-near", selected=0)

SITUATIONS = {
    "empty": Situation(None),
    "empty-dark-large": Situation(None, size=LARGE, theme="dark"),
    "disk": Situation("disk-4", selected=0),
    "disk-dark": Situation("disk-4", theme="dark", selected=0),
    "disk-double": Situation("disk-4", scale=2, selected=0),
    "invalid": README,
    "made-valid-large": Situation("annulus-near", ("make-valid",), size=LARGE),
    "quads": Situation("sphere-cube", ("mesh",)),
    "quads-dark-large": Situation("sphere-cube", ("mesh",), size=LARGE, theme="dark"),
    "layout": Situation("suboptimal-c", layers=("layout",)),
    "anisotropic-large": Situation("suboptimal-c", size=LARGE),
    "gallery": Situation("disk-4", ("gallery",)),
}


def take(situation: Situation, path: Path) -> None:
    """Show a window in a situation, and write its picture."""
    ensure_rendering()
    app = application()
    window = MainWindow()
    window.appearance.prefer(replace(window.appearance.preferences, theme=situation.theme))
    window.resize(*situation.size)
    window.show()

    def settle(done: Callable[[], bool] = lambda: True) -> None:
        start = rested = time.monotonic()
        while time.monotonic() < min(rested + REST, start + PATIENCE):
            app.processEvents()
            if window.session.busy or not done():
                rested = time.monotonic()

    settle()
    if situation.case is not None:
        window.files.open(situation.case)
        settle(lambda: window.state.solved)
    for name in situation.actions:
        window.actions_table.by_name[name].trigger()
        settle()
    for layer in situation.layers:
        window.session.looks.toggle_layer(layer)
        settle()
    if situation.selected is not None:
        window.session.pointer.select(situation.selected)
        settle()
    dialogs = [d for d in window.findChildren(QDialog) if d.isVisible()]
    (dialogs[0] if dialogs else window).grab().save(str(path))
    for dialog in dialogs:
        dialog.close()
    if window.state.document is not None:
        window.session.edits.keep()  # nobody is asked
    window.close()


def sheet(pictures: list[Path]) -> QImage:
    """Return pictures side by side, each in a cell of its own."""
    width, height = CELL
    rows = -(-len(pictures) // COLUMNS)
    made = QImage(
        COLUMNS * (width + GAP) + GAP, rows * (height + GAP) + GAP, QImage.Format.Format_RGB32
    )
    made.fill(Qt.GlobalColor.gray)
    painter = QPainter(made)
    for number, picture in enumerate(pictures):
        row, column = divmod(number, COLUMNS)
        image = QImage(str(picture)).scaled(
            width, height, Qt.AspectRatioMode.KeepAspectRatio,
            Qt.TransformationMode.SmoothTransformation,
        )  # fmt: skip
        left = GAP + column * (width + GAP) + (width - image.width()) // 2
        painter.drawImage(left, GAP + row * (height + GAP) + (height - image.height()) // 2, image)
    painter.end()
    return made


def main(arguments: list[str]) -> int:
    """Take the pictures, each in a process of its own: the scale is chosen when Qt starts."""
    if arguments[:1] == ["--take"]:
        with TemporaryDirectory() as own:  # as at first, whatever the user's own panels are
            QSettings.setDefaultFormat(QSettings.Format.IniFormat)
            QSettings.setPath(QSettings.Format.IniFormat, QSettings.Scope.UserScope, own)
            take({"readme": README, **SITUATIONS}[arguments[1]], Path(arguments[2]))
        return 0
    if arguments == ["readme"]:
        return _in_own_process("readme", README, ROOT / "resources" / "screenshot.png")
    folder = Path(arguments[0]) if arguments else ROOT / "build" / "screenshots"
    folder.mkdir(parents=True, exist_ok=True)
    pictures = []
    for name in arguments[1:] or SITUATIONS:
        picture = folder / f"{name}.png"
        if status := _in_own_process(name, SITUATIONS[name], picture):
            return status
        pictures.append(picture)
    sheet(pictures).save(str(folder / "sheet.png"))
    return 0


def _in_own_process(name: str, situation: Situation, path: Path) -> int:
    """Take one picture, and return the status of the process."""
    scaled = {**os.environ, "QT_SCALE_FACTOR": str(situation.scale)}
    command = [sys.executable, "-m", "tools.screenshots", "--take", name, str(path)]
    return subprocess.run(command, cwd=ROOT, env=scaled, check=False).returncode


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
