"""What is done in a session and what follows, with real solves and no display."""

import subprocess
import sys
import threading
from collections.abc import Generator, Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from crossview.cases.gallery import path_of
from crossview.cases.model import Case
from crossview.session.document import Document
from crossview.session.message import ShowWhere
from crossview.session.opening import Opening
from crossview.session.shown import Nothing, Provisional, Solved
from crossview.session.state import SessionState
from crossview.workflow.layout import SOON
from crossview.workflow.quads import MeshOptions
from solvers.progress import Progress
from solvers.remedies import RepairSurface, UseMethod
from tests.crossview.session.headless import Headless, known
from tests.pinched import pinched


@pytest.fixture
def held() -> Iterator[Headless]:
    made = Headless()
    yield made
    made.session.close()
    assert not any(timer.running for timer in made.loop.timers)


@pytest.fixture
def far(tmp_path: Path) -> str:
    """An annulus whose isotropic field misses the inner boundary by 37 degrees."""
    path = tmp_path / "far.json"
    replace(Case.load(path_of("annulus-far")), method="isotropic").save(path)
    return str(path)


def test_it_needs_neither_qt_nor_vtk() -> None:
    program = (
        "import sys, crossview.session.session; print(*{m.split('.')[0] for m in sys.modules})"
    )
    loaded = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    ).stdout.split()
    assert "crossview" in loaded
    assert not {"PySide6", "pyvista", "pyvistaqt", "vtkmodules"} & set(loaded)


def test_opening_solves_and_tells(held: Headless) -> None:
    told: list[Opening] = []
    held.session.opened.append(told.append)
    held.open("disk-4")
    assert [opening.target for opening in told] == ["disk-4"]
    assert held.state.solved
    assert isinstance(held.state.shown, Solved)
    assert held.state.field is held.state.solution.field
    assert held.state.undo_name is None
    assert held.state.separatrices is not None  # their layer is shown
    assert held.state.progress is None
    assert any(state.progress is not None for state in held.seen)


def test_what_cannot_be_opened_is_refused_and_what_was_open_stays(
    held: Headless, tmp_path: Path
) -> None:
    held.open("disk-4")
    before = held.state
    held.open(str(tmp_path / "missing.obj"))
    assert held.state.message.cause == "open"
    assert "missing.obj" in held.state.message.below
    assert held.state.document is before.document
    assert held.state.shown is before.shown
    held.session.dismiss()
    assert held.state.message is None


def test_a_bad_file_is_shown_where_it_is_wrong_and_repaired(held: Headless, tmp_path: Path) -> None:
    held.open(pinched(tmp_path / "bad.obj"))
    message = held.state.message
    kinds = {type(remedy): remedy for remedy in message.remedies}
    held.session.carry_out(kinds[ShowWhere], message.tried)
    held.wait()
    assert held.state.faulty is not None
    assert held.state.shown_surface is None
    assert ShowWhere not in [type(remedy) for remedy in held.state.message.remedies]
    held.session.carry_out(kinds[RepairSurface], message.tried)
    held.wait()
    assert held.state.message is None
    assert held.state.document.surface.n_faces == 14
    assert held.state.solved  # eight corners: the indices add up


def test_dragging_follows_and_dropping_solves(held: Headless) -> None:
    held.open("disk-4")
    before, session = held.state, held.session
    assert session.trials.start_drag(0)
    assert held.state.focus.selected == 0
    for x in (0.5, 0.45, 0.4):
        session.trials.drag_to(held.on_surface(x, 0.2, 0.0))
    held.wait()
    assert isinstance(held.state.shown, Provisional)
    assert held.state.field is not before.field
    assert held.state.field.surface is held.state.base.surface
    assert held.state.document is before.document
    np.testing.assert_allclose(held.position(0), (0.4, 0.2, 0.0), atol=1e-9)
    held.wait(lambda: held.state.meshes.of is held.state.field)  # traced at rest at the latest
    session.trials.drop()
    assert held.state.undo_name == "move singularity 1"
    assert not held.state.solved
    assert isinstance(held.state.shown, Provisional)  # seen until the refined one is there
    held.wait()
    assert held.state.solved
    np.testing.assert_allclose(held.position(0), (0.4, 0.2, 0.0), atol=1e-9)
    session.edits.undo()
    held.wait()
    assert held.state.document is before.document
    assert held.state.redo_name == "move singularity 1"


def test_a_drag_waits_for_nothing_that_takes_a_while_to_stop(held: Headless) -> None:
    held.open("disk-4")
    session, release = held.session, threading.Event()

    def unbroken() -> Generator[Progress, None, None]:
        release.wait()
        yield Progress("stopped at last", 1.0)

    def fail(error: Exception) -> None:
        raise error

    session.solving.run(unbroken, lambda result: None, fail)
    assert session.trials.start_drag(0)
    session.trials.drag_to(held.on_surface(0.5, 0.2, 0.0))
    held.wait(lambda: isinstance(held.state.shown, Provisional))
    release.set()
    session.trials.drop()
    held.wait(lambda: held.state.solved)
    np.testing.assert_allclose(held.position(0), (0.5, 0.2, 0.0), atol=1e-9)


def test_a_large_surface_is_laid_out_only_for_its_layer_and_quads(held: Headless) -> None:
    built = {"builtin": "annulus", "inner": 0.4, "n": 390}
    case = Case.from_json({"surface": built, "method": "isotropic"})
    held.session.edits.open(Document.from_case("large", case))
    held.wait(lambda: held.state.made.settled)
    assert held.state.solution.surface.n_faces > SOON
    assert held.state.made.layout is None
    held.session.looks.toggle_layer("layout")
    held.wait()
    assert known(held.state.made.layout).patches == 1


def test_a_drag_put_back_changes_nothing(held: Headless) -> None:
    held.open("disk-4")
    before = held.state
    held.session.trials.start_drag(1)
    held.session.trials.drag_to(held.on_surface(0.1, 0.6, 0.0))
    held.wait()
    assert held.state.field is not before.field
    held.session.trials.cancel()
    held.wait()
    assert held.state.trial is None
    assert held.state.document is before.document
    assert held.state.field is before.field
    assert held.state.undo_name == before.undo_name


def test_what_is_locked_cannot_be_dragged(held: Headless) -> None:
    held.open("disk-4")
    held.session.edits.toggle_lock(2)
    held.wait()
    before = held.state
    assert not held.session.trials.start_drag(2)
    held.session.trials.drag_to(held.on_surface(0.0, 0.0, 0.0))
    held.session.trials.drop()
    held.wait()
    assert held.state.document is before.document


def test_with_shift_a_drag_keeps_to_where_the_loop_closes(held: Headless) -> None:
    held.open("annulus-near")
    assert not held.state.valid
    held.session.trials.start_drag(0)
    held.session.trials.drag_to(held.on_surface(0.72, 0.12, 0.0), keep=True)
    assert np.abs(np.degrees(known(held.state.defects))).max() < 0.5
    held.session.trials.cancel()
    held.wait()


def test_the_guide_follows_what_is_hovered(held: Headless) -> None:
    held.open("annulus-near")
    assert held.state.guide == ()
    held.session.pointer.hover(0)
    held.wait(lambda: len(held.state.guide) > 0)
    held.session.pointer.hover(None)
    assert held.state.guide == ()


def test_stopping_keeps_the_last_iterate(held: Headless, far: str) -> None:
    held.open(far)
    held.once(
        lambda state: state.iterating is not None and len(state.iterating.step.energies) > 20,
        held.session.solving.stop,
    )
    held.session.edits.choose_method("alternating")
    held.wait()
    assert held.state.message.stopped
    assert "kept, not converged" in held.state.message.text
    assert held.state.solved
    field = held.state.field
    assert not field.convergence.converged
    energies = field.convergence.energies
    assert len(energies) > 20
    assert field.energy == pytest.approx(energies[-1])
    assert held.state.start.energy == pytest.approx(energies[0])
    # an edit goes on as if nothing had been
    held.session.edits.choose_method("anisotropic")
    held.wait()
    assert held.state.message is None
    assert held.state.field.energy < 1e-10


def test_stopping_before_there_is_an_iterate_keeps_what_was_there(held: Headless, far: str) -> None:
    held.open(far)
    before = held.state
    held.session.edits.choose_method("anisotropic")
    held.session.solving.stop()
    held.wait()
    assert held.state.message.text == "Stopped; what was there is kept"
    assert held.state.shown is before.shown
    assert not held.state.solved
    held.session.solving.solve()
    held.wait()
    assert held.state.solved
    assert held.state.message is None


def test_iterates_are_seen_on_the_way(held: Headless, far: str) -> None:
    held.open(far)
    held.seen.clear()
    held.session.edits.choose_method("anisotropic")
    held.wait()
    running = [state for state in held.seen if state.iterating is not None]
    assert running
    assert all(state.field.surface is state.shown_surface for state in running)
    lengths = [len(state.iterating.step.energies) for state in running]
    assert lengths == sorted(lengths)
    assert held.state.iterating is None


@pytest.mark.parametrize("method", [None, "mbo"])
def test_stopping_moves_leaves_the_document(held: Headless, far: str, method: str | None) -> None:
    held.open(far)
    before = held.state
    held.once(lambda state: state.progress is not None, held.session.solving.stop)
    if method is None:
        held.session.moves.make_valid()
    else:
        held.session.moves.place_natural(method)
    held.wait()
    assert held.state.message.text == "Stopped; nothing was changed"
    assert held.state.document is before.document
    assert held.state.singularities == before.document.singularities
    assert held.state.field is before.field


def test_making_valid_is_one_step(held: Headless) -> None:
    held.open("annulus-near")
    held.session.edits.choose_method("isotropic")
    held.wait()
    before = held.state
    held.seen.clear()
    held.session.moves.make_valid()
    held.wait()
    assert any(state.moving is not None for state in held.seen)
    assert held.state.moving is None
    assert held.state.valid
    assert held.state.undo_name == "make valid"
    held.session.edits.undo()
    held.wait()
    assert held.state.document is before.document
    assert not held.state.valid


def test_indices_that_do_not_add_up_are_refused_a_field_and_mended(held: Headless) -> None:
    held.open("disk-4")
    held.session.edits.remove(3)
    held.wait()
    assert isinstance(held.state.shown, Nothing)
    assert held.state.base is not None
    held.session.pointer.take_tool(3)
    held.session.trials.preview(held.on_surface(0.0, -0.5, 0.0))
    assert held.state.budget.satisfied  # it would do
    held.session.edits.add(held.on_surface(0.0, -0.5, 0.0), known(held.state.added_valence))
    held.wait()
    assert held.state.solved
    assert held.state.focus.selected == 3
    held.session.edits.undo()
    held.session.edits.undo()
    held.wait()
    assert held.state.solved
    assert held.state.undo_name is None
    held.session.edits.redo()
    held.wait()
    assert held.state.field is None


def test_a_newer_edit_overtakes_a_solve(held: Headless) -> None:
    held.open("sphere-cube")
    for _ in range(3):
        held.session.edits.toggle_lock(0)
    held.session.edits.toggle_lock(1)
    held.wait()
    assert held.state.solved
    assert [s.locked for s in held.state.singularities[:3]] == [True, True, False]


def test_quads_wait_for_the_field_and_refusals_name_the_remedy(held: Headless, far: str) -> None:
    held.open(far)
    held.session.quad_making.make(MeshOptions(target_quads=300))
    held.wait()
    message = held.state.message
    assert message.cause == "mesh"
    assert held.state.made.quads is None
    remedy = next(r for r in message.remedies if isinstance(r, UseMethod))
    held.session.carry_out(remedy, message.tried)
    held.wait(lambda: held.state.made.quads is not None)
    assert held.state.message is None
    assert held.state.method == remedy.method
    assert held.state.layers["quads"].visible


def test_observers_hear_of_changes_in_their_order(held: Headless) -> None:
    """One that changes the state while it is told makes no other hear of it too early."""
    session = held.session
    heard: list[tuple[SessionState, SessionState]] = []

    def answer(old: SessionState, new: SessionState) -> None:
        if new.dark and not new.poor:
            session.looks.show_poor(True)

    session.observers.insert(0, answer)
    session.observers.append(lambda old, new: heard.append((old, new)))
    session.looks.toggle_dark()
    assert [(new.dark, new.poor) for _, new in heard] == [(True, False), (True, True)]
    assert heard[0][1] is heard[1][0]
    session.update(replace(session.state, dark=True))  # nothing differs
    assert len(heard) == 2
