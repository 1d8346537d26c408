"""Where no isotropic field is aligned: other methods, watched and compared, or moving."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QPushButton

from crossview.cases.gallery import path_of
from crossview.cases.model import Builtin, Case, Options, PlacedCorner
from crossview.session.state import SessionState
from crossview.view.colors import BAD, GOOD, UNSURE, valence_color
from solvers.fields import IsotropicSolver
from solvers.validity import Unevenness
from tests.windowing import Hand

Cases = Callable[[str], str]
KEYPAD = Qt.KeyboardModifier.KeypadModifier


@pytest.fixture
def isotropic_case(tmp_path: Path) -> Cases:
    """Makes a gallery case that asks for the isotropic method first."""

    def make(name: str) -> str:
        path = tmp_path / f"{name}.json"
        replace(Case.load(path_of(name)), method="isotropic").save(path)
        return str(path)

    return make


def choose(hand: Hand, label: str) -> None:
    """Choose a method in the toolbar and wait for its field."""
    box = hand.window.method_box
    row = box.findText(label)
    box.setCurrentIndex(row)
    box.activated.emit(row)
    hand.wait(lambda: hand.state.solved)


def test_anisotropic_where_isotropic_fails_and_back(hand: Hand, isotropic_case: Cases) -> None:
    hand.open(isotropic_case("annulus-far"))
    panel = hand.window.convergence_panel
    assert "37 degrees" in panel.verdict.text()
    assert hand.window.validity_panel.rows[0].color == BAD
    isotropic = hand.state.field
    camera, limits = hand.window.viewport.scene.camera, hand.window.viewport.scene.limits

    # watch E fall: the field of several iterations is drawn before the last
    texts, drawn = set(), []

    def watch(old: SessionState, new: SessionState) -> None:
        texts.add(hand.window.status.stage.text())
        if new.iterating is not None and new.field is not old.field:
            drawn.append((new.iterating.step.energies, new.field))

    hand.window.session.observers.append(watch)
    choose(hand, "Anisotropic")
    hand.window.session.observers.remove(watch)
    assert len(drawn) >= 1
    assert any(text.startswith("Newton 1  E = ") for text in texts)
    assert all(field.surface is hand.state.shown_surface for _, field in drawn)
    assert all(1e-10 < energies[-1] < energies[0] for energies, _ in drawn[:1])

    # the verdict is said, E before and after and the aspect too
    anisotropic = hand.state.field
    assert anisotropic.energy < 1e-10
    assert anisotropic.convergence.converged
    assert panel.verdict.text().startswith("The field is aligned and integrable")
    assert panel.facts.text().startswith("E 1.7 → ")
    assert "times longer than wide" in panel.facts.text()
    assert panel.plot.energies == anisotropic.convergence.energies
    # where it is integrable the smoothing begins, which leaves E = 0 for a moment: this is shown
    begun = panel.plot.convergence.smoothed_from
    assert begun is not None
    assert begun == anisotropic.convergence.smoothed_from
    assert panel.plot.energies[begun] < 1e-10 < panel.plot.energies[begun + 1]
    assert f"after {begun} the sizes are smoothed" in panel.plot.toolTip()
    row = hand.window.validity_panel.rows[0]
    assert (row.color, row.value.text()) == (UNSURE, "−37.0°")

    # one key for each method: the same results at once, camera and colours as they were
    assert hand.window.viewport.scene.camera == camera
    assert hand.window.viewport.scene.limits == limits
    hand.key(Qt.Key.Key_1, KEYPAD)
    hand.wait(lambda: hand.state.solved)
    assert hand.state.field is isotropic
    assert hand.window.method_box.currentText() == "Isotropic"
    hand.key(Qt.Key.Key_3, KEYPAD)
    hand.wait(lambda: hand.state.solved)
    assert hand.state.field is anisotropic
    assert hand.state.added_valence is None  # the keypad's 3 is not the 3 that adds
    hand.key(Qt.Key.Key_2, KEYPAD)
    hand.wait(lambda: hand.state.solved)
    assert hand.state.field.method == "aligned"
    assert np.abs(hand.state.field.boundary_misalignment).max() < 1e-9
    assert "not integrable" in panel.verdict.text()
    assert hand.window.viewport.scene.limits == limits

    # the method is a step of the history like any other
    assert hand.state.undo_name == "choose method theta imposed"
    hand.trigger("undo")
    hand.wait(lambda: hand.state.solved)
    assert hand.state.field is anisotropic


def test_the_error_density_before_and_after_on_one_range(hand: Hand, isotropic_case: Cases) -> None:
    hand.open(isotropic_case("annulus-far"))
    actions = hand.window.actions_table.by_name
    assert not actions["compare"].isEnabled()
    choose(hand, "Anisotropic")
    scene, panel = hand.window.viewport.scene, hand.window.convergence_panel
    camera = scene.camera
    hand.trigger("layer-error")
    panel.button.click()
    before, limits = hand.picture(), scene.limits
    assert actions["compare"].isChecked()
    assert hand.state.layers["error"].visible
    hand.key(Qt.Key.Key_C)
    after = hand.picture()
    assert scene.limits == limits
    assert scene.camera == camera
    assert not actions["compare"].isChecked()
    assert np.abs(before.astype(int) - after.astype(int)).mean() > 5.0
    assert after.mean() > before.mean()  # the error density is white where there is none


def test_stop_keeps_the_last_iterate(hand: Hand, isotropic_case: Cases) -> None:
    hand.open(isotropic_case("annulus-far"))
    stop = hand.window.actions_table.by_name["stop"]

    def stop_soon(old: SessionState, new: SessionState) -> None:
        if new.iterating is not None and len(new.iterating.step.energies) > 20:
            hand.window.session.observers.remove(stop_soon)
            stop.trigger()

    hand.window.session.observers.append(stop_soon)
    choose(hand, "Alternating (paper)")
    hand.wait(lambda: hand.state.message is not None)
    assert "the last iterate is kept, not converged" in hand.said
    field, panel = hand.state.field, hand.window.convergence_panel
    assert field.method == "alternating"
    assert not field.convergence.converged
    energies = field.convergence.energies
    assert len(energies) > 20
    assert field.energy == pytest.approx(energies[-1])
    assert energies[-1] < energies[0]
    assert panel.verdict.text().startswith("Not converged")
    assert panel.plot.energies == energies
    # it goes with the next edit
    choose(hand, "Isotropic")
    assert hand.state.message is None


def test_an_edit_is_solved_by_the_chosen_method_on_release(
    hand: Hand, isotropic_case: Cases
) -> None:
    hand.open(isotropic_case("annulus-near"))
    choose(hand, "Anisotropic")
    solved = hand.state.field
    start = hand.place_of(0)
    end = hand.place((0.75, 0.15, 0.0))
    hand.drag(start, end)
    hand.wait(lambda: hand.state.field is not solved)
    assert hand.state.field.method == "isotropic"
    hand.release(end)
    hand.wait(lambda: hand.state.solved)
    assert hand.state.field.method == "anisotropic"
    assert hand.state.field.energy < 1e-10
    assert hand.shows(valence_color(3), end)


def test_improve_shows_its_way_and_is_one_step(hand: Hand, isotropic_case: Cases) -> None:
    hand.open(isotropic_case("annulus-near"))
    panel = hand.window.validity_panel
    before = hand.state.document
    on_the_way = []
    hand.window.session.observers.append(
        lambda old, new: on_the_way.append(new.singularities) if new.moving is not None else None
    )
    panel.places.improve.click()
    hand.wait(lambda: hand.state.solved and hand.state.document is not before)
    assert len(set(on_the_way)) > 3
    assert hand.state.undo_name == "improve sizes"
    assert hand.said.startswith("Sizes are more even: variance of H ")
    unevenness = Unevenness(IsotropicSolver(before.surface))
    sizes = [unevenness.sizes(d.singularities).variance for d in (before, hand.state.document)]
    assert sizes[1] < sizes[0]
    assert panel.rows[0].color == GOOD
    hand.trigger("undo")
    hand.wait(lambda: hand.state.solved)
    assert hand.state.document is before


def test_improve_stopped_keeps_what_it_has_reached(hand: Hand, isotropic_case: Cases) -> None:
    hand.open(isotropic_case("annulus-near"))
    before = hand.state.document
    seen = []

    def stop_on_the_way(old: SessionState, new: SessionState) -> None:
        if new.moving is not None and new.progress.stage == "improving":
            seen.append(new.singularities)
            if len(set(seen)) == 3:
                hand.window.session.observers.remove(stop_on_the_way)
                hand.trigger("stop")

    hand.window.session.observers.append(stop_on_the_way)
    hand.trigger("improve")
    hand.wait(lambda: hand.state.solved and hand.state.document is not before)
    # what the background has reached, perhaps a step beyond what was shown
    unevenness = Unevenness(IsotropicSolver(before.surface))
    shown, kept = (unevenness.sizes(x).variance for x in (seen[-1], hand.state.singularities))
    assert kept <= shown
    assert hand.state.undo_name == "improve sizes"
    assert np.abs(hand.state.solution.holonomy_defects).max() < np.radians(0.5)


def test_improve_needs_something_that_may_move(hand: Hand, isotropic_case: Cases) -> None:
    hand.open(isotropic_case("annulus-near"))
    for i in range(8):
        assert hand.window.validity_panel.places.improve.isEnabled()
        hand.window.session.edits.toggle_lock(i)
    assert not hand.window.validity_panel.places.improve.isEnabled()


def test_make_valid_and_undo(hand: Hand, isotropic_case: Cases) -> None:
    hand.open(isotropic_case("annulus-near"))
    panel = hand.window.validity_panel
    before = hand.state.document
    assert (panel.rows[0].color, hand.window.convergence_panel.color) == (BAD, UNSURE)
    assert panel.places.make_valid.isEnabled()
    on_the_way = []
    hand.window.session.observers.append(
        lambda old, new: (
            on_the_way.append((new.singularities, panel.rows[0].value.text()))
            if new.moving is not None
            else None
        )
    )
    panel.places.make_valid.click()
    hand.wait(lambda: hand.state.solved and hand.state.document is not before)
    assert len({text for _, text in on_the_way}) > 1
    assert any(places != before.singularities for places, _ in on_the_way)
    assert panel.rows[0].color == GOOD
    assert not panel.places.make_valid.isEnabled()
    assert np.abs(hand.state.solution.holonomy_defects).max() < np.radians(1e-3)
    assert hand.window.convergence_panel.verdict.text().startswith("The field is aligned")
    assert hand.state.undo_name == "make valid"
    hand.trigger("undo")
    hand.wait(lambda: hand.state.solved)
    assert hand.state.document is before
    assert panel.rows[0].color == BAD


def test_what_cannot_be_made_valid_says_why_and_what_else(
    hand: Hand, isotropic_case: Cases
) -> None:
    hand.open(isotropic_case("annulus-near"))
    for i in range(8):
        hand.window.session.edits.toggle_lock(i)
    hand.wait(lambda: hand.state.solved)
    before, field = hand.state.document, hand.state.field
    hand.window.validity_panel.places.make_valid.click()
    hand.wait(lambda: hand.state.message is not None)
    assert "too few singularities may move" in hand.said
    assert "around the inner boundary, 3" in hand.said
    assert hand.state.document is before
    assert hand.state.field is field
    bar = hand.window.centre.message_bar
    next(b for b in bar.findChildren(QPushButton) if b.text() == "Solve anisotropic").click()
    hand.wait(lambda: hand.state.solved and hand.state.method == "anisotropic")
    assert hand.state.message is None
    assert hand.state.field.energy < 1e-10


@pytest.mark.parametrize("when", ["make-valid", "natural-mbo"])
def test_stop_leaves_the_document_as_it_was(hand: Hand, isotropic_case: Cases, when: str) -> None:
    hand.open(isotropic_case("annulus-far"))
    before, field = hand.state.document, hand.state.field
    actions = hand.window.actions_table.by_name

    def stop_at_once(old: SessionState, new: SessionState) -> None:
        if new.progress is not None:
            hand.window.session.observers.remove(stop_at_once)
            actions["stop"].trigger()

    hand.window.session.observers.append(stop_at_once)
    hand.trigger(when)
    hand.wait(lambda: hand.state.message is not None)
    assert hand.said == "Stopped; nothing was changed"
    assert hand.state.document is before
    assert hand.state.singularities == before.singularities
    assert hand.state.field is field


def test_natural_singularities_with_one_selected(
    hand: Hand, capsys: pytest.CaptureFixture[str]
) -> None:
    hand.open("disk-4")
    hand.window.session.pointer.select(3)
    hand.trigger("natural-mbo")
    hand.wait(lambda: hand.state.solved)
    assert hand.state.undo_name == "natural singularities (MBO)"
    assert "Error" not in capsys.readouterr().err  # of those that Qt only prints


def test_natural_singularities_with_one_in_hand(
    hand: Hand, capsys: pytest.CaptureFixture[str]
) -> None:
    hand.open("disk-4")
    hand.key(Qt.Key.Key_3)
    hand.move(hand.place((-0.5613, 0.0765, 0.0)))
    hand.wait()
    # on a triangle that only the refined surface has: natural ones come from the other
    assert hand.state.trial.placed.face >= hand.state.document.surface.n_faces
    hand.window.actions_table.by_name["natural-mbo"].trigger()
    hand.wait(lambda: hand.state.undo_name == "natural singularities (MBO)" and hand.state.solved)
    assert "Error" not in capsys.readouterr().err


def test_natural_singularities_of_a_disk(hand: Hand) -> None:
    hand.open("disk-4")
    before = hand.state.document
    hand.trigger("natural-globally-optimal")
    hand.wait(lambda: hand.state.document is not before and hand.state.solved)
    assert hand.state.undo_name == "natural singularities (Globally optimal)"
    hand.trigger("natural-mbo")
    hand.wait(lambda: hand.state.undo_name == "natural singularities (MBO)")
    hand.wait(lambda: hand.state.solved)
    assert [s.valence for s in hand.state.singularities] == [3, 3, 3, 3]
    assert hand.state.budget.satisfied
    hand.trigger("undo")
    hand.trigger("undo")
    hand.wait(lambda: hand.state.solved)
    assert hand.state.document is before


def test_the_torus_that_is_never_valid_is_not_said_to_be(hand: Hand) -> None:
    hand.open("torus-35")
    hand.wait(lambda: hand.state.solved)
    hand.trigger("make-valid")
    hand.wait(lambda: hand.state.message is not None)
    assert "never valid" in hand.said
    (only,) = hand.state.message.remedies  # no method makes up for it
    assert only.label.startswith("Add a pair of 3 and 5 near")
    choose(hand, "Anisotropic")
    panel = hand.window.convergence_panel
    assert panel.verdict.text().startswith("No quadrangulation of a torus has one valence 3")
    assert panel.color == BAD


def test_what_is_impossible_is_said_before_any_solve_and_one_click_mends_it(
    hand: Hand, tmp_path: Path
) -> None:
    """A valence 4 does not hide it; the theorem is named; a pair leads to what is possible."""
    path = tmp_path / "torus.json"
    case = Case.load(path_of("torus-35"))
    four = replace(case.singularities[0], position=(0.0, 1.4, 0.0), valence=4)
    replace(case, singularities=(*case.singularities, four)).save(path)
    hand.open(path)
    panel = hand.window.validity_panel
    assert panel.budget.color == GOOD
    assert panel.existence.color == BAD
    assert panel.existence.isVisibleTo(panel)
    assert "Izmestiev" in panel.note.text()
    (button,) = panel.buttons
    assert button.text() == "Add a pair of valences 3 and 5"
    button.click()
    hand.wait(lambda: hand.state.solved)
    assert [s.valence for s in hand.state.singularities] == [3, 5, 4, 3, 5]
    assert not panel.existence.isVisibleTo(panel)
    assert not panel.buttons
    hand.trigger("undo")
    assert panel.existence.isVisibleTo(panel)


def test_corners_to_and_fro_are_mended_by_taking_them_away(hand: Hand, tmp_path: Path) -> None:
    path = tmp_path / "annulus.json"
    corners = (PlacedCorner((1.0, 0.0, 0.0), 1), PlacedCorner((-1.0, 0.0, 0.0), -1))
    Case(Builtin("annulus", {"n": 24}), (), corners).save(path)
    hand.open(path)
    panel = hand.window.validity_panel
    assert panel.existence.isVisibleTo(panel)
    pair, straight = panel.buttons
    assert pair.text() == "Add a pair of valences 3 and 5"
    straight.click()
    hand.wait(lambda: hand.state.solved)
    assert hand.state.document is not None
    assert not hand.state.document.corners
    assert not panel.existence.isVisibleTo(panel)
    assert hand.state.undo_name == "change 2 corners"
    assert hand.window.convergence_panel.color == GOOD


def test_turns_of_a_cylinder_are_mended_by_taking_none(hand: Hand, tmp_path: Path) -> None:
    path = tmp_path / "annulus.json"
    options = Options(turns=(1,))
    Case(Builtin("annulus", {"n": 24}), (), None, "anisotropic", options).save(path)
    hand.open(path)
    panel = hand.window.validity_panel
    assert panel.existence.isVisibleTo(panel)
    assert hand.window.convergence_panel.color == BAD
    panel.buttons[0].click()
    hand.wait(lambda: hand.state.solved)
    assert not panel.existence.isVisibleTo(panel)
    assert hand.window.convergence_panel.color == GOOD
