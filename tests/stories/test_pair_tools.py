"""Pairs, merging, splitting, mirroring, completing, and the offers of Make valid."""

import json
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QPointF, Qt
from PySide6.QtWidgets import QApplication

from crossview.view.colors import valence_color
from tests.windowing import Hand

CTRL = Qt.KeyboardModifier.ControlModifier


def polar(radius: float, degrees: float) -> list[float]:
    return [radius * np.cos(np.radians(degrees)), radius * np.sin(np.radians(degrees)), 0.0]


def saved(
    tmp_path: Path, surface: object, *placed: tuple[Sequence[float], int], locked: bool = False
) -> str:
    singularities = [
        {"position": list(map(float, p)), "valence": v, "locked": locked} for p, v in placed
    ]
    path = tmp_path / "case.json"
    path.write_text(json.dumps({"surface": surface, "singularities": singularities}))
    return str(path)


def valences(hand: Hand) -> list[int]:
    return [s.valence for s in hand.state.singularities]


def places(hand: Hand) -> np.ndarray:
    return hand.state.document.surface.positions([s.point for s in hand.state.singularities])


def test_add_a_pair_under_the_mouse_split_merge_and_undo(hand: Hand) -> None:
    hand.open("disk-4")
    hand.move(hand.place((0.1, 0.1, 0.0)))
    hand.key(Qt.Key.Key_P)
    hand.wait()
    assert valences(hand) == [3, 3, 3, 3, 3, 5]
    np.testing.assert_allclose(places(hand)[4:].mean(axis=0), [0.1, 0.1, 0.0], atol=0.01)
    assert hand.state.undo_name == "add a pair of 3 and 5"
    assert hand.state.budget.satisfied
    assert hand.state.field is not None

    # two selected by Ctrl and a click become one, here none
    hand.click(hand.place_of(4))
    assert not hand.window.actions_table.by_name["merge"].isEnabled()
    hand.click(hand.place_of(5), keys=CTRL)
    assert hand.state.focus.pair == (4, 5)
    hand.trigger("merge")
    assert valences(hand) == [3, 3, 3, 3]
    assert hand.state.undo_name == "merge singularities 5 and 6"
    assert hand.state.focus.selected is None

    # 3 and 3 become a 2, and split again
    hand.click(hand.place_of(0))
    hand.click(hand.place_of(1), keys=CTRL)
    hand.trigger("merge")
    assert valences(hand) == [2, 3, 3]
    assert hand.shows(valence_color(2), hand.place_of(0))
    hand.click(hand.place_of(0))
    hand.trigger("split")
    assert valences(hand) == [3, 3, 3, 3]
    assert hand.state.undo_name == "split singularity 1"
    for _ in range(4):
        hand.trigger("undo")
    assert valences(hand) == [3, 3, 3, 3]
    assert hand.state.undo_name is None


def test_refusals_are_told_in_one_line_and_change_nothing(hand: Hand) -> None:
    hand.open("disk-4")
    before = hand.state.document
    hand.click(hand.place_of(0))
    hand.trigger("split")
    assert "valence 3 cannot be split" in hand.said
    assert hand.state.document is before
    hand.move(hand.place((0.995, 0.0, 0.0)))
    hand.key(Qt.Key.Key_P)
    hand.wait()
    assert "no room" in hand.said
    assert hand.state.document is before


def test_a_pair_without_a_place_goes_where_there_is_room(hand: Hand) -> None:
    hand.open("disk-4")
    before = places(hand)
    hand.move(QPointF(2, 2))  # beside the disk
    hand.trigger("add-pair")
    hand.wait(lambda: len(hand.state.singularities) == 6)
    middle = places(hand)[4:].mean(axis=0)
    room = min(1 - np.linalg.norm(middle), np.linalg.norm(before - middle, axis=1).min())
    assert room > 0.3


def test_mirror_and_rotate(hand: Hand, tmp_path: Path) -> None:
    hand.open(saved(tmp_path, {"builtin": "square"}, ([0.1, 0.3, 0], 3), ([-0.2, 0.1, 0], 5)))
    x = places(hand)
    hand.trigger("mirror-x")
    np.testing.assert_allclose(places(hand), x * [-1, 1, 1], atol=1e-6)
    assert hand.state.undo_name == "mirror across x"
    hand.trigger("undo")
    hand.trigger("rotate-z")
    np.testing.assert_allclose(places(hand), x[:, [1, 0, 2]] * [-1, 1, 1], atol=1e-6)
    assert hand.state.undo_name == "rotate about z"


def test_the_panel_distributes_what_is_missing(hand: Hand) -> None:
    hand.open("sphere")
    buttons = hand.window.validity_panel.buttons
    labels = [button.text() for button in buttons]
    buttons[labels.index("Distribute the missing index")].click()
    hand.wait(lambda: hand.state.field is not None)
    x = places(hand)
    assert valences(hand) == [3] * 8
    assert np.degrees(np.arccos((x @ x.T - 2 * np.eye(8)).max())) > 60
    assert hand.state.undo_name == "add 8 singularities"
    assert not hand.window.actions_table.by_name["distribute"].isEnabled()


def test_the_impossible_torus_is_offered_a_pair_that_works(hand: Hand) -> None:
    hand.open("torus-35")
    hand.trigger("make-valid")
    hand.wait(lambda: hand.state.message is not None)
    assert "never valid" in hand.said
    assert valences(hand) == [3, 5]
    buttons = hand.window.centre.message_bar.action_buttons
    assert [button.text()[:26] for button in buttons] == ["Add a pair of 3 and 5 near"]
    buttons[0].click()
    hand.wait(lambda: hand.state.solved and hand.state.field is not None)
    assert valences(hand) == [3, 5, 3, 5]
    assert hand.state.valid
    assert hand.state.message is None
    assert hand.state.undo_name == "make valid, one more pair"
    hand.trigger("undo")
    assert valences(hand) == [3, 5]


def test_locked_singularities_are_offered_a_pair_or_the_anisotropic_field(
    hand: Hand, tmp_path: Path
) -> None:
    placed = ((polar(0.6, 20), 3), (polar(0.8, 80), 5))
    hand.open(saved(tmp_path, {"builtin": "annulus", "inner": 0.4}, *placed, locked=True))
    hand.trigger("make-valid")
    hand.wait(lambda: hand.state.message is not None)
    assert "too few singularities may move" in hand.said
    assert "around the inner boundary, 15" in hand.said
    buttons = hand.window.centre.message_bar.action_buttons
    before = places(hand)
    assert [button.text()[:10] for button in buttons] == ["Add a pair", "Solve anis"]
    buttons[0].click()
    hand.wait(lambda: hand.state.solved)
    assert hand.state.valid
    np.testing.assert_array_equal(places(hand)[:2], before)
    hand.trigger("undo")
    hand.trigger("make-valid")
    hand.wait(lambda: hand.state.message is not None)
    hand.window.centre.message_bar.action_buttons[-1].click()
    hand.wait(lambda: hand.state.solved)
    assert hand.state.method == "anisotropic"


@pytest.mark.parametrize("place", [(0.0, 0.0), (0.3, -0.2)])
def test_the_scene_menu_adds_a_pair_where_it_was_asked_for(
    hand: Hand, place: tuple[float, float]
) -> None:
    hand.open("disk-4")
    there = hand.place((*place, 0.0))
    hand.click(there, Qt.MouseButton.RightButton)
    hand.window.actions_table.by_name["add-pair"].trigger()
    hand.wait()
    np.testing.assert_allclose(places(hand)[4:].mean(axis=0), [*place, 0.0], atol=0.01)
    for menu in hand.window.findChildren(type(hand.window.menus.menu("File"))):
        menu.close()


def test_a_pair_without_room_keeps_no_field_from_being_solved(hand: Hand, tmp_path: Path) -> None:
    path = tmp_path / "two.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n")
    hand.window.files.open(str(path))
    while hand.state.document is None:
        QApplication.processEvents()
    assert not hand.state.solved
    hand.trigger("add-pair")
    assert hand.said.startswith("there is no room")
    assert hand.state.solved
