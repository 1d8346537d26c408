"""From valid places to better ones: separatrices that meet, fewer singularities."""

import json
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QPointF, Qt

from crossview.cases.model import Builtin, Case, PlacedSingularity
from crossview.session.commands import ReplaceSingularities
from crossview.session.state import SessionState
from crossview.view.colors import NEAR_MISS, WAITING
from crossview.workflow.coarseness import Coarseness
from crossview.workflow.configurations import complete, make_valid
from crossview.workflow.problem import Problem
from solvers.fields import prepare
from solvers.layouts.near_misses import SeparatrixWays
from solvers.progress import run
from solvers.surface import FloatArray
from tests.windowing import Hand

OFF = ((0.5, 0.03, 0.0), (0.0, 0.5, 0.0), (-0.5, 0.0, 0.0), (0.0, -0.5, 0.0))
PAIR = (PlacedSingularity((0.1, 0.0, 0.0), 3), PlacedSingularity((-0.1, 0.05, 0.0), 5))


@pytest.fixture
def off(hand: Hand, tmp_path: Path) -> Path:
    """A disk in the window, one of its four singularities off the corner of their square."""
    path = tmp_path / "off.json"
    threes = tuple(PlacedSingularity(place, 3) for place in OFF)
    Case(Builtin("disk", {"edge_length": 0.1}), threes).save(path)
    hand.open(path)
    return path


def test_snap_makes_separatrices_meet_in_one_step(hand: Hand, off: Path) -> None:
    before = hand.state.document
    on_the_way = []
    hand.window.session.observers.append(
        lambda old, new: on_the_way.append(new.singularities) if new.moving is not None else None
    )
    hand.window.validity_panel.places.snap.click()
    hand.wait(lambda: hand.state.solved and hand.state.document is not before)
    assert len(set(on_the_way)) > 1
    assert hand.said.startswith("4 connections between singularities, which moved by up to 0.0")
    assert hand.state.undo_name == "snap separatrices"
    hand.trigger("undo")
    hand.wait(lambda: hand.state.solved)
    assert hand.state.document is before


def snapped(hand: Hand) -> FloatArray:
    """Places of the singularities after one more snap."""
    before = hand.state.document
    hand.trigger("snap")
    hand.wait(lambda: hand.state.solved and hand.state.document is not before)
    return places(hand)


def places(hand: Hand) -> FloatArray:
    return hand.state.document.surface.positions([s.point for s in hand.state.singularities])


def test_what_is_snapped_stays(hand: Hand, off: Path) -> None:
    start, once, twice = places(hand), snapped(hand), snapped(hand)
    moves = [np.linalg.norm(b - a, axis=1).max() for a, b in pairwise((start, once, twice))]
    assert moves[1] < 0.1 * moves[0]


@pytest.fixture
def more(hand: Hand, off: Path, tmp_path: Path) -> Path:
    """The same with a pair more."""
    path = tmp_path / "more.json"
    case = Case.load(off)
    Case(case.surface, (*case.singularities, *PAIR)).save(path)
    hand.open(path)
    return path


def test_simplify_leaves_as_many_as_the_panel_says(hand: Hand, more: Path) -> None:
    panel, before = hand.window.validity_panel.places, hand.state.document
    assert (panel.most.minimum(), panel.most.value(), panel.most.maximum()) == (4, 4, 5)
    hand.window.session.pointer.select(5)
    panel.simplify.click()
    hand.wait(lambda: hand.state.solved and hand.state.document is not before)
    assert [s.valence for s in hand.state.singularities] == [3, 3, 3, 3]
    assert hand.said == "6 singularities before, 4 now, every loop closed"
    assert hand.state.undo_name == "simplify to 4"
    assert np.abs(hand.state.solution.holonomy_defects).max(initial=0.0) < np.radians(1e-3)
    hand.trigger("undo")
    hand.wait(lambda: hand.state.solved)
    assert hand.state.document is before


@pytest.mark.parametrize("name", ["snap", "simplify"])
def test_stopped_they_change_nothing(hand: Hand, more: Path, name: str) -> None:
    before, field = hand.state.document, hand.state.field

    def stop_at_once(old: SessionState, new: SessionState) -> None:
        if new.progress is not None:
            hand.window.session.observers.remove(stop_at_once)
            hand.window.actions_table.by_name["stop"].trigger()

    hand.window.session.observers.append(stop_at_once)
    hand.trigger(name)
    hand.wait(lambda: hand.state.message is not None)
    assert hand.said == "Stopped; nothing was changed"
    assert hand.state.document is before
    assert hand.state.field is field


def test_what_is_locked_leaves_nothing_to_better(hand: Hand, off: Path) -> None:
    panel = hand.window.validity_panel.places
    buttons = (panel.improve, panel.snap)
    for i in range(4):
        assert all(button.isEnabled() for button in buttons)
        hand.window.session.edits.toggle_lock(i)
    assert not any(button.isEnabled() for button in buttons)


def test_the_panel_tells_how_coarse_the_layout_is_that_a_drag_is_to_better(
    hand: Hand, off: Path
) -> None:
    row = hand.window.validity_panel.places.coarseness
    before = hand.state.made.layout
    assert before is not None
    told = str(Coarseness.of(before))
    assert (row.text.text(), row.value.text()) == (told, "")
    place = hand.place_of(0)
    hand.drag(place, hand.place((0.4, 0.15, 0.0)))
    hand.wait()
    assert (row.text.text(), row.value.text()) == (told, "before")
    hand.release(hand.place((0.4, 0.15, 0.0)))
    hand.wait(lambda: hand.state.solved and hand.state.made.layout is not None)
    assert (row.text.text(), row.value.text()) == (str(Coarseness.of(hand.state.made.layout)), "")
    assert row.text.text() != told


def test_where_there_is_no_layout_the_panel_tells_so(hand: Hand) -> None:
    hand.open("annulus-near")
    hand.trigger("method-isotropic")
    assert hand.state.made.trouble is not None
    row = hand.window.validity_panel.places.coarseness
    assert (row.text.text(), row.color) == ("No layout", WAITING)


def misses(hand: Hand) -> FloatArray:
    """By how much separatrices miss that are to join the document's singularities, degrees."""
    problem = hand.state.document.problem
    ways = SeparatrixWays(prepare(problem.surface, problem.singularities))
    angles = np.full((4, 4), np.inf)
    one, other = np.sort(ways.passings.nodes, axis=1).T
    np.minimum.at(angles, (one, other), np.degrees(ways.passings.angles))
    return np.array([angles[pair] for pair in problem.connections])


def test_what_snap_has_joined_is_kept_until_it_is_let_go(
    hand: Hand, off: Path, tmp_path: Path
) -> None:
    panel = hand.window.validity_panel.places
    assert not panel.let_go.isVisible()
    snapped(hand)
    assert hand.state.document.connections == ((0, 1), (0, 3), (1, 2), (2, 3))
    assert (panel.connections.text(), panel.let_go.isVisible()) == ("4 connections kept", True)

    case, again = hand.state.document.to_case(), tmp_path / "again.json"
    case.save(again)
    assert json.loads(again.read_text())["connections"] == [[0, 1], [0, 3], [1, 2], [2, 3]]
    hand.open(again)
    assert hand.state.document.connections == case.connections

    before = hand.state.document
    panel.improve.click()
    hand.wait(lambda: hand.state.solved and hand.state.document is not before)
    assert hand.state.document.connections == case.connections
    assert misses(hand).max() < 0.5

    hand.window.session.edits.remove(1)
    assert hand.state.document.connections == ((0, 2), (1, 2))
    hand.trigger("undo")
    hand.window.session.pointer.select(1)
    panel.let_go.click()
    assert hand.state.document.connections == ((0, 3), (2, 3))
    hand.window.session.edits.change_valence(0, 5)
    assert hand.state.document.connections == ((2, 3),)
    hand.trigger("undo")
    hand.trigger("undo")
    assert hand.state.document.connections == case.connections
    hand.trigger("undo")
    assert hand.state.document is before
    assert not hand.window.actions_table.by_name["undo"].isEnabled()


def test_what_cannot_be_kept_joined_says_so(hand: Hand, off: Path) -> None:
    snapped(hand)
    hand.window.session.edits.move({0: hand.state.shown_surface.closest_point([0.3, 0.25, 0.0])})
    hand.wait()
    before = hand.state.document
    hand.trigger("improve")
    hand.wait(lambda: hand.state.message is not None)
    assert "singularities 1 and 4 cannot be kept joined" in hand.said
    assert hand.state.document is before


def test_where_none_can_be_merged_simplify_is_not_offered(hand: Hand) -> None:
    hand.open("sphere-cube")
    panel = hand.window.validity_panel.places
    assert not panel.simplify.isEnabled()
    assert not panel.most.isEnabled()
    assert panel.most.text() == "to 8"
    hand.trigger("add-pair")
    assert panel.simplify.isEnabled()
    assert (panel.most.minimum(), panel.most.value(), panel.most.maximum()) == (8, 8, 9)
    hand.window.session.edits.toggle_lock(8, 9)
    assert not panel.simplify.isEnabled()


def middle_of(hand: Hand, number: int) -> QPointF:
    """A place in the viewport halfway along a near miss."""
    found = hand.state.near_misses
    points = found.points[found.offsets[number] : found.offsets[number + 1]]
    return hand.place(points[len(points) // 2])


def test_a_click_on_a_near_miss_makes_it_a_connection(hand: Hand, off: Path) -> None:
    found = hand.state.near_misses
    pairs = [tuple(sorted(pair)) for pair in found.pairs.tolist()]
    assert sorted(pairs) == [(0, 1), (0, 3), (1, 2), (2, 3)]
    place, before = middle_of(hand, pairs.index((0, 1))), hand.state.document
    assert hand.shows(NEAR_MISS, place, 12, line=True)
    hand.move(place)
    assert hand.canvas.toolTip() == "Nearly joins singularities 1 and 2: a click does"
    hand.click(place)
    hand.wait(lambda: hand.state.solved and hand.state.document is not before)
    assert hand.state.document.connections == ((0, 1),)
    assert hand.state.undo_name == "connect singularities 1 and 2"
    assert misses(hand).max() < 0.5
    left = [sorted(pair) for pair in hand.state.near_misses.pairs.tolist()]
    assert [0, 1] not in left
    hand.trigger("undo")
    hand.wait(lambda: hand.state.solved)
    assert hand.state.document is before


def test_near_misses_come_and_go_with_the_guide_and_a_drag(hand: Hand, off: Path) -> None:
    place = middle_of(hand, 0)
    start = hand.place_of(0)
    hand.drag(start, hand.place((0.45, 0.05, 0.0)))
    hand.wait()
    assert hand.state.near_misses is None
    hand.key(Qt.Key.Key_Escape)
    hand.wait()
    assert hand.state.near_misses is not None
    hand.trigger("layer-guide")
    assert hand.state.near_misses is None
    before = hand.state.document
    hand.click(place)
    hand.wait()
    assert hand.state.document is before


def test_each_condition_has_its_row_from_the_start(hand: Hand, tmp_path: Path) -> None:
    made = Builtin("plate_with_holes", {"holes": 3, "edge_length": 0.15})
    placed = run(make_valid(run(complete(Problem.from_case(Case(made))))))[0]
    path = tmp_path / "plate.json"
    placed.to_case(made).save(path)
    hand.open(path)
    rows = hand.window.validity_panel.rows
    assert len(rows) == 3
    assert not rows[0].visibleRegion().isEmpty()
    hand.window.session.edits.do(
        ReplaceSingularities(hand.state.singularities, "connect", connections=((0, 1),))
    )
    hand.window.resize(960, 500)
    hand.wait()
    assert hand.window.height() == 500
    assert rows[0].visibleRegion().boundingRect() == rows[0].rect()
