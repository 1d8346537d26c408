"""The docks stand where they stood in the last session."""

from collections.abc import Callable, Iterator

import pytest
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from crossview.gui.main_window import MainWindow


@pytest.fixture
def session(
    app: QApplication, settings: None, nothing_left: None
) -> Iterator[Callable[[], MainWindow]]:
    """Starts windows one after the other; each is closed when the next one comes."""
    windows: list[MainWindow] = []

    def close() -> None:
        for window in windows:
            window.close()
            window.deleteLater()
        windows.clear()

    def start() -> MainWindow:
        close()
        windows.append(MainWindow())
        windows[-1].show()
        assert QTest.qWaitForWindowExposed(windows[-1])
        return windows[-1]

    yield start
    close()


def test_docks_and_size_come_back(session: Callable[[], MainWindow]) -> None:
    first = session()
    assert first.docks["Validity"].isVisible()
    first.resize(1150, 760)
    first.docks["Validity"].close()
    first.docks["Quads"].raise_()
    again = session()
    assert not again.docks["Validity"].isVisible()
    assert again.docks["Surface"].isVisible()
    assert (again.width(), again.height()) == (1150, 760)
    again.actions_table.by_name["reset-docks"].trigger()
    assert again.docks["Validity"].isVisible()
    assert session().docks["Validity"].isVisible()
