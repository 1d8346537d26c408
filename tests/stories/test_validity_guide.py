"""Following the guide: where a singularity may go, and the drag that keeps to it."""

import json
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QEvent, QPointF, Qt
from PySide6.QtGui import QEnterEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QWidget

from crossview.view.colors import condition_color
from tests.windowing import Hand, count_color

SHIFT = Qt.KeyboardModifier.ShiftModifier


def polar(radius: float, degrees: float) -> list[float]:
    return [radius * np.cos(np.radians(degrees)), radius * np.sin(np.radians(degrees)), 0.0]


def saved(tmp_path: Path, builtin: dict[str, object], *placed: tuple[Sequence[float], int]) -> str:
    singularities = [{"position": list(map(float, p)), "valence": v} for p, v in placed]
    path = tmp_path / "case.json"
    path.write_text(json.dumps({"surface": builtin, "singularities": singularities}))
    return str(path)


@pytest.fixture
def annulus(tmp_path: Path) -> str:
    """By closed form off by (20 - 80) / 4 degrees; closed where both lie on one ray."""
    return saved(
        tmp_path, {"builtin": "annulus", "inner": 0.4}, (polar(0.6, 20), 3), (polar(0.8, 80), 5)
    )


def drawn(hand: Hand, condition: int) -> int:
    return count_color(hand.picture(), condition_color(condition))


def rays(hand: Hand) -> list[tuple[bool, float]]:
    """Of each guide line whether it is emphasised, and its mean polar angle."""
    found = []
    for line in hand.state.guide:
        x, y, _ = line.segments.reshape(-1, 3).T
        found.append((line.strong, float(np.degrees(np.arctan2(y.mean(), x.mean())))))
    return found


def enter(row: QWidget, inside: bool) -> None:
    here = QPointF(5, 5)
    kind = QEnterEvent(here, here, here) if inside else QEvent(QEvent.Type.Leave)
    QApplication.sendEvent(row, kind)
    QApplication.processEvents()


def test_the_guide_shows_the_ray_to_go_to_and_shift_keeps_to_it(hand: Hand, annulus: str) -> None:
    hand.open(annulus)
    assert hand.state.defects == pytest.approx([np.radians(-15)], abs=1e-3)
    assert hand.state.guide == ()
    assert drawn(hand, 0) == 0

    # hovering shows the ray on which it closes, and the one it is on
    hand.move(hand.place_of(0))
    hand.wait()
    (thin, here), (thick, there) = rays(hand)
    assert (thin, thick) == (False, True)
    assert here == pytest.approx(20, abs=0.2)
    assert there == pytest.approx(80, abs=0.2)
    on_line = hand.place(polar(0.5, 80))
    assert hand.shows(condition_color(0), on_line, line=True)

    # dragged with Shift it keeps to that ray, however the mouse goes
    hand.drag(hand.place_of(0), hand.place(polar(0.55, 70)), keys=SHIFT)
    hand.wait()
    assert hand.window.validity_panel.rows[0].value.text() == "0°"
    x, y, _ = hand.state.document.surface.position(hand.state.singularities[0].point)
    assert np.degrees(np.arctan2(y, x)) == pytest.approx(80, abs=0.2)
    assert np.hypot(x, y) == pytest.approx(0.55, abs=0.04)
    hand.release(hand.place(polar(0.55, 70)))
    hand.wait(lambda: hand.state.solved)
    assert hand.state.valid
    assert hand.state.undo_name == "move singularity 1"

    # closed: one thin line to stay on; it goes with the mouse
    hand.move(hand.place_of(0))
    hand.wait()
    assert [strong for strong, _ in rays(hand)] == [False]
    hand.move(hand.place(polar(0.7, -60)))
    hand.wait()
    assert hand.state.guide == ()
    assert drawn(hand, 0) == 0


def test_dragging_freely_leaves_the_lines_where_they_are(hand: Hand, annulus: str) -> None:
    hand.open(annulus)
    hand.drag(hand.place_of(0), hand.place(polar(0.6, -30)))
    hand.wait()
    assert sorted(round(angle) for _, angle in rays(hand)) == [20, 80]
    defects = hand.state.defects
    assert defects is not None
    assert np.degrees(defects[0]) == pytest.approx((-30 - 80) / 4, abs=0.5)
    hand.key(Qt.Key.Key_Escape)
    hand.wait()


def test_the_add_tool_shows_where_the_last_one_closes(hand: Hand, tmp_path: Path) -> None:
    hand.open(saved(tmp_path, {"builtin": "annulus", "inner": 0.4}, (polar(0.8, 80), 5)))
    hand.key(Qt.Key.Key_3)
    hand.move(hand.place(polar(0.7, -20)))
    hand.wait()
    ((strong, angle),) = rays(hand)
    assert strong
    assert angle == pytest.approx(80, abs=0.2)
    hand.key(Qt.Key.Key_5)  # the budget would be missed: nothing to follow
    hand.move(hand.place(polar(0.7, -25)))
    hand.wait()
    assert hand.state.guide == ()


def test_a_row_pointed_at_shows_its_condition_alone_and_a_click_pins_it(
    hand: Hand, tmp_path: Path
) -> None:
    placed = (([1.4, 0, 0], 3), ([0, 1.4, 0], 3), ([-1.4, 0, 0], 5), ([0.2, -1, 0.4], 5))
    hand.open(saved(tmp_path, {"builtin": "torus", "n": 48}, *placed))
    rows = hand.window.validity_panel.rows
    assert len(rows) == 2
    place = next(
        hand.place_of(i)
        for i in range(4)
        if hand.window.viewport.singularity_at(hand.place_of(i)) == i
    )
    hand.move(place)
    hand.wait()
    assert len(hand.state.guide) == 2
    assert drawn(hand, 0) > 50
    assert drawn(hand, 1) > 50
    QTest.mouseClick(rows[1], Qt.MouseButton.LeftButton)
    hand.wait()
    assert {line.color for line in hand.state.guide} == {condition_color(1)}
    assert rows[1].text.font().bold()
    QTest.mouseClick(rows[1], Qt.MouseButton.LeftButton)
    hand.wait()
    assert len({line.color for line in hand.state.guide}) == 2

    # with the mouse over a row it is the selected singularity that is guided
    hand.click(place)
    hand.move(QPointF(3, 3))
    hand.wait()
    assert not hand.state.guide
    enter(rows[0], True)
    hand.wait()
    assert {line.color for line in hand.state.guide} == {condition_color(0)}
    enter(rows[0], False)
    hand.wait()
    assert not hand.state.guide


def test_the_guide_can_be_hidden(hand: Hand, annulus: str) -> None:
    hand.open(annulus)
    hand.trigger("layer-guide")
    hand.move(hand.place_of(0))
    hand.wait()
    assert hand.state.guide == ()
    hand.trigger("layer-guide")
    hand.move(hand.place_of(0) + QPointF(1, 0))
    hand.wait()
    assert len(hand.state.guide) == 2
