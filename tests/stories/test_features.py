"""Features marked in the window."""

import json
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from PySide6.QtCore import QPointF, Qt
from PySide6.QtWidgets import QApplication

from crossview.cases.model import Case
from crossview.view.colors import FEATURE, PROBLEM
from tests.windowing import Hand, count_color

SPHERE = {
    "surface": {"builtin": "cube_sphere", "n": 12},
    "singularities": [
        {"position": [x, y, z], "valence": 3}
        for x in (-0.577, 0.577)
        for y in (-0.577, 0.577)
        for z in (-0.577, 0.577)
    ],
    "options": {"refine": 1},
}

SHIFT = Qt.KeyboardModifier.ShiftModifier


@pytest.fixture
def sphere(hand: Hand, tmp_path: Path) -> Hand:
    """The window with a sphere and the cube's eight, separatrices off."""
    path = tmp_path / "sphere.json"
    path.write_text(json.dumps(SPHERE))
    hand.window.session.looks.toggle_layer("separatrices")
    hand.open(path)
    return hand


def features_of(hand: Hand) -> int:
    features = hand.state.features
    assert features is not None
    return len(features)


def edge_middle(hand: Hand, edge: int) -> QPointF:
    surface = hand.state.document.surface
    return hand.place(surface.vertices[surface.edges[edge]].mean(axis=0))


def facing(hand: Hand, places: NDArray[np.int64], least: float = 0.5) -> NDArray[np.int64]:
    """Which of the edges (numbers) of a sphere about the origin face the eye, away from discs."""
    surface = hand.state.document.surface
    eye = np.array(hand.canvas.renderer.GetActiveCamera().GetPosition())
    middle = surface.vertices[surface.edges[places]].mean(axis=1)
    singular = surface.positions([s.point for s in hand.state.singularities])
    away = np.linalg.norm(middle[:, None] - singular, axis=2).min(axis=1) > 0.4
    return np.asarray(places[(middle @ (eye / np.linalg.norm(eye)) > least) & away])


def test_sharp_edges_are_shown_as_the_angle_changes_and_taken_when_it_rests(
    sphere: Hand, tmp_path: Path
) -> None:
    hand = sphere
    box = hand.window.surface_panel.features
    box.sharp.setChecked(True)
    assert features_of(hand) == 0
    before = hand.state.document
    box.angle.setValue(3)
    shown = features_of(hand)
    assert shown > 0
    assert hand.state.document is before
    assert hand.shows(FEATURE)
    hand.wait(lambda: hand.state.document is not before)
    assert hand.state.document.problem.marking.dihedral_degrees == 3
    assert f"{shown:,}".replace(",", "\u2009") in box.found.text()
    hand.trigger("undo")
    assert box.angle.value() == 40
    hand.trigger("undo")
    assert not box.sharp.isChecked()
    assert features_of(hand) == 0
    assert count_color(hand.picture(), FEATURE) == 0


def test_a_click_marks_an_edge_and_a_second_one_takes_the_mark_away(sphere: Hand) -> None:
    hand = sphere
    hand.trigger("mark-edges")
    surface = hand.state.document.surface
    edge = int(facing(hand, np.arange(len(surface.edges)), 0.8)[0])
    place = edge_middle(hand, edge)
    hand.move(place)
    assert set(np.asarray(hand.state.mark_tool.path)) == set(surface.edges[edge])
    hand.click(place)
    hand.wait()
    assert hand.state.document.problem.features.edges.tolist() == [edge]
    assert "1 edge in 1 curve" in hand.window.surface_panel.features.found.text()
    assert hand.state.undo_name == "mark an edge"
    hand.click(place)
    hand.wait()
    assert len(hand.state.document.problem.features) == 0
    hand.trigger("undo")
    hand.trigger("undo")
    assert features_of(hand) == 0


def test_shift_marks_the_path_from_the_last_click_and_a_case_keeps_it(
    sphere: Hand, tmp_path: Path
) -> None:
    hand = sphere
    hand.trigger("mark-edges")
    surface = hand.state.document.surface
    ahead = facing(hand, np.arange(len(surface.edges)), 0.8)
    start, end = edge_middle(hand, ahead[0]), edge_middle(hand, ahead[-1])
    hand.click(start)
    hand.wait()
    hand.click(end, keys=SHIFT)
    hand.wait()
    features = hand.state.document.problem.features
    assert len(features) > 2
    assert hand.state.undo_name == f"mark {len(features) - 1} edges"
    hand.key(Qt.Key.Key_Escape)
    assert hand.state.mark_tool is None
    marked = features.edges.tolist()
    hand.state.document.to_case().save(tmp_path / "case.json")
    assert len(Case.load(tmp_path / "case.json").features.curves) == len(features.curves)
    hand.open(tmp_path / "case.json")
    assert hand.state.document.problem.features.edges.tolist() == marked


def test_the_anisotropic_field_follows_what_the_isotropic_one_misses(sphere: Hand) -> None:
    hand = sphere
    hand.trigger("mark-edges")
    surface = hand.state.document.surface
    ahead = facing(hand, np.arange(len(surface.edges)), 0.8)
    hand.click(edge_middle(hand, ahead[0]))
    hand.wait()
    hand.click(edge_middle(hand, ahead[-1]), keys=SHIFT)
    hand.trigger("select")
    hand.move(hand.place([9, 9, 9]))
    found = hand.window.surface_panel.features.found
    assert "off by up to" in found.text()
    assert count_color(hand.picture(), PROBLEM) > 0
    hand.trigger("method-anisotropic")
    hand.wait(lambda: hand.state.solution is not None and hand.state.solved)
    assert "followed" in found.text()
    assert count_color(hand.picture(), PROBLEM) == 0
    assert count_color(hand.picture(), FEATURE) > 0


def test_natural_singularities_are_drawn_on_their_way_and_stopping_breaks_nothing(
    sphere: Hand,
) -> None:
    hand = sphere
    before, solution = hand.state.document, hand.state.solution
    seen = []
    hand.window.session.observers.append(
        lambda old, new: seen.append(new) if new.moving is not None else None
    )
    hand.window.actions_table.by_name["natural-mbo"].trigger()
    hand.wait(lambda: bool(seen) or hand.state.document is not before)
    hand.window.actions_table.by_name["stop"].trigger()
    hand.wait()
    assert hand.state.document is before or seen
    drawn = [state for state in seen if state.field is not None and not state.singularities]
    assert drawn
    assert drawn[-1].field.surface is before.surface
    assert drawn[-1].shown_surface is before.surface
    if hand.state.document is before:
        assert hand.state.field is solution.field
        assert hand.state.base is not None


def test_natural_singularities_follow_sharp_edges_and_curvature(hand: Hand) -> None:
    hand.open("ellipsoid")
    hand.trigger("along-curvature")
    assert hand.state.along_curvature
    hand.trigger("natural-globally-optimal")
    hand.wait(lambda: len(hand.state.singularities) > 0)
    assert sum(s.index for s in hand.state.singularities) == 8
    # the four umbilics of an ellipsoid lie in the plane of its longest and shortest axis
    surface = hand.state.document.surface
    places = surface.positions([s.point for s in hand.state.singularities])
    assert np.abs(places[:, 1]).max() < 0.3


def test_a_stopped_natural_field_leaves_nothing_where_there_was_none(hand: Hand) -> None:
    hand.open("sphere")
    assert hand.state.field is None
    hand.window.actions_table.by_name["natural-mbo"].trigger()
    while hand.state.field is None:
        QApplication.processEvents()
    assert hand.state.moving is not None
    hand.window.actions_table.by_name["stop"].trigger()
    hand.wait()
    assert hand.state.field is None
    assert hand.state.singularities == ()
    assert "nothing was changed" in hand.said


def test_as_few_natural_singularities_as_may_be(hand: Hand) -> None:
    hand.open("torus")
    hand.trigger("fewest-natural")
    assert hand.state.fewest_natural
    hand.trigger("natural-mbo")
    hand.wait(lambda: hand.state.undo_name == "natural singularities (MBO, fewest)")
    assert hand.state.singularities == ()
