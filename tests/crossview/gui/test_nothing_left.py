"""The fixture that watches for leaks must see them."""

import threading

import pyvista as pv
from PySide6.QtCore import QTimer
from PySide6.QtWidgets import QApplication, QWidget
from vtkmodules.vtkRenderingCore import vtkRenderWindow

from tests.windowing import living


def test_it_sees_what_is_left(app: QApplication) -> None:
    release = threading.Event()
    thread = threading.Thread(target=release.wait)
    thread.start()
    timer = QTimer()
    timer.start(10_000)
    widget = QWidget()
    plotter = pv.Plotter(off_screen=True)
    found = living(app)
    assert thread in found
    assert timer in found
    assert widget in found
    assert any(isinstance(thing, vtkRenderWindow) for thing in found)
    release.set()
    thread.join()
    timer.stop()
    widget.deleteLater()
    plotter.close()
