"""Long work: the window lives on, and can be told to stop."""

import json
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QTimer

from crossview.session.state import SessionState
from tests.windowing import Hand


@pytest.fixture
def large_case(tmp_path: Path) -> str:
    """A torus of some 20 000 triangles with two pairs of singularities on top."""
    places = [(1.0, 0.0, 0.4), (-1.0, 0.0, 0.4), (0.0, 1.0, 0.4), (0.0, -1.0, 0.4)]
    case = {
        "surface": {"builtin": "torus", "n": 144},
        "singularities": [
            {"position": place, "valence": valence}
            for place, valence in zip(places, (3, 5, 3, 5), strict=True)
        ],
    }
    path = tmp_path / "large.json"
    path.write_text(json.dumps(case))
    return str(path)


def test_events_are_heard_while_it_solves(hand: Hand, large_case: str) -> None:
    hand.open(large_case)
    stages, ticks = set(), []
    timer = QTimer()
    timer.setInterval(5)
    timer.timeout.connect(lambda: ticks.append(hand.state.progress))
    hand.window.session.observers.append(
        lambda old, new: stages.add(new.progress.stage if new.progress else "")
    )
    timer.start()
    hand.trigger("clear")
    hand.trigger("undo")  # places solved before are refined and factored anew
    hand.wait(lambda: hand.state.solved)
    timer.stop()
    assert sum(progress is not None for progress in ticks) >= 5
    assert {"factorising", "solving"} <= stages
    assert "" in stages  # and the bar is gone


def test_stop_keeps_what_was_there_and_solve_goes_on(hand: Hand, large_case: str) -> None:
    hand.open(large_case)
    before = hand.state.field
    session = hand.window.session
    stop = hand.window.actions_table.by_name["stop"]

    def stop_at_factor(old: SessionState, new: SessionState) -> None:
        if new.progress is not None and new.progress.stage == "factorising":
            stop.trigger()

    session.observers.append(stop_at_factor)
    point = hand.state.document.surface.closest_point((0.0, 1.2, 0.3))
    session.trials.start_drag(2)
    session.trials.drag_to(hand.state.base.refinement.locate(point))
    session.trials.drop()
    hand.wait(lambda: hand.state.message is not None)
    session.observers.remove(stop_at_factor)
    assert hand.said == "Stopped; what was there is kept"
    assert hand.state.undo_name == "move singularity 3"
    assert not hand.state.solved
    assert hand.state.field.surface is before.surface
    hand.trigger("solve")
    hand.wait(lambda: hand.state.solved)
    assert hand.state.message is None


def test_a_new_edit_overtakes_a_solve(hand: Hand, large_case: str) -> None:
    hand.open(large_case)
    session = hand.window.session
    session.edits.toggle_lock(0)
    session.edits.change_valence(2, 5)
    session.edits.change_valence(1, 3)  # at once, the first never comes back
    hand.wait(lambda: hand.state.solved)
    assert [s.valence for s in hand.state.solution.singularities] == [3, 3, 5, 5]
    assert np.isfinite(hand.state.field.H).all()
