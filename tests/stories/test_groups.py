"""Several singularities are selected by a band and moved together, each move one step."""

import numpy as np
import pytest
from PySide6.QtCore import QPointF, Qt

from tests.windowing import Hand

CTRL = Qt.KeyboardModifier.ControlModifier
LEFT = Qt.MouseButton.LeftButton


def places(hand: Hand) -> np.ndarray:
    surface = hand.state.document.surface
    return np.asarray(surface.positions([s.point for s in hand.state.singularities]))


def test_a_band_selects_what_is_seen_in_it_and_adds_to_what_was(hand: Hand) -> None:
    hand.open("disk-4")
    before = hand.window.viewport.scene.camera.text
    at = places(hand)
    right = [i for i in range(4) if at[i, 0] > 0.1]
    (left,) = np.flatnonzero(at[:, 0] < -0.1)
    hand.window.session.pointer.select(int(left))
    start, end = hand.place((0.05, 0.95, 0.0)), hand.place((0.95, -0.95, 0.0))
    hand.drag(start, end, keys=CTRL)
    assert hand.window.mouse.group.band.isVisible()
    hand.release(end, keys=CTRL)
    assert not hand.window.mouse.group.band.isVisible()
    assert set(hand.state.focus.all) == {*right, int(left)}
    assert hand.window.viewport.scene.camera.text == before


def test_a_band_leaves_out_what_is_on_the_far_side(hand: Hand) -> None:
    hand.open("sphere-cube")
    hand.trigger("view-xy")
    start, end = QPointF(2.0, 2.0), QPointF(hand.canvas.width() - 3.0, hand.canvas.height() - 3.0)
    hand.drag(start, end, keys=CTRL)
    hand.release(end, keys=CTRL)
    assert all(places(hand)[list(hand.state.focus.all), 2] > 0)
    assert len(hand.state.focus.all) == 4


def test_arrow_keys_move_what_is_selected_but_not_what_is_locked(hand: Hand) -> None:
    hand.open("disk-4")
    hand.window.session.edits.toggle_lock(3)
    hand.canvas.setFocus()
    hand.key(Qt.Key.Key_A, CTRL)
    before = places(hand)
    hand.key(Qt.Key.Key_Right)
    hand.wait()
    moved = places(hand) - before
    assert (moved[:3, 0] > 0.005).all()
    np.testing.assert_allclose(moved[:3, 1:], 0.0, atol=1e-3)
    np.testing.assert_allclose(moved[3], 0.0)
    assert hand.state.undo_name == "move 3 singularities"
    hand.key(Qt.Key.Key_Up)
    hand.wait()
    assert (places(hand)[:3, 1] - before[:3, 1] > 0.005).all()
    hand.trigger("undo")
    hand.trigger("undo")
    np.testing.assert_allclose(places(hand), before)


def test_a_drag_of_one_takes_the_others_along(hand: Hand) -> None:
    hand.open("disk-4")
    before = places(hand)
    hand.window.session.pointer.select(0)
    hand.window.session.pointer.select(2, both=True)
    start = hand.place_of(0)
    end = start + QPointF(0.0, 30.0)
    hand.drag(start, end)
    hand.release(end)
    hand.wait()
    moved = places(hand) - before
    assert moved[0, 1] < -0.03
    assert moved[2] == pytest.approx(moved[0], abs=5e-3)
    np.testing.assert_allclose(moved[[1, 3]], 0.0)
    assert hand.state.undo_name == "move 2 singularities"
    hand.trigger("undo")
    np.testing.assert_allclose(places(hand), before)
