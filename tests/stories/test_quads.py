"""From a case to quads in a file, and what happens where there can be none."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import pyvista as pv
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QApplication, QLabel, QPushButton

from crossview.cases.gallery import path_of
from crossview.cases.model import Case
from crossview.gui.panels.quads import COUNT, LENGTH, LENGTHS, NOTHING, STALE, QuadsPanel
from crossview.session.state import SessionState
from crossview.view.colors import BAD, CROSS, GOOD, MARK_WARNING, PATCHES, QUAD_EDGE, valence_color
from tests.inverted import INVERTED
from tests.windowing import Hand, count_color

BLUE = valence_color(3)


@pytest.fixture
def isotropic_plate(tmp_path: Path) -> str:
    """The plate whose isotropic field misses two holes."""
    path = tmp_path / "plate.json"
    replace(Case.load(path_of("suboptimal-a")), method="isotropic").save(path)
    return str(path)


def offer(hand: Hand, label: str) -> QPushButton:
    """The button of the message bar with this label."""
    buttons = hand.window.centre.message_bar.action_buttons
    return next(button for button in buttons if button.text() == label)


def mark(panel: QuadsPanel) -> str:
    """The colour of the sign beside what is said of the quads."""
    sign = panel.findChild(QLabel, "dot").pixmap().toImage()
    return sign.pixelColor(sign.width() // 2, sign.height() // 6).name()


def quads_of(path: Path) -> tuple[int, np.ndarray]:
    lines = path.read_text().splitlines()
    faces = [line.split()[1:] for line in lines if line.startswith("f ")]
    assert all(len(face) == 4 for face in faces)
    return sum(line.startswith("v ") for line in lines), np.array(faces, int)


def test_sphere_to_six_patches_to_quads_to_a_file(hand: Hand, tmp_path: Path) -> None:
    window, actions = hand.window, hand.window.actions_table.by_name
    assert not actions["mesh"].isEnabled()
    hand.open("sphere-cube")
    assert not actions["save-quads"].isEnabled()
    assert window.quads_panel.said.text() == NOTHING

    # the separatrices are there, exact: twelve from corner to corner
    assert len(hand.state.separatrices.valences) == 12

    # the layout: six patches in colours of which neighbours differ
    window.session.looks.toggle_layer("layout")
    hand.wait()
    assert hand.state.made.layout.patches == 6
    assert hand.state.made.layout.conforming
    picture = hand.picture()
    shown = [color for color in PATCHES if count_color(picture, color) > 200]
    assert len(shown) >= 2
    window.session.looks.toggle_layer("layout")

    # about 1 500 quads
    panel = window.quads_panel
    panel.count_box.setValue(1500)
    hand.key(Qt.Key.Key_F6)
    hand.wait(lambda: hand.state.made.quads is not None)
    quads = hand.state.made.quads
    assert abs(quads.n_quads - 1500) < 75
    assert hand.state.layers["quads"].visible
    assert window.layers_panel.list.currentItem().text() == "Quads"
    picture = hand.picture()
    assert count_color(picture, QUAD_EDGE) > 2000
    assert count_color(picture, CROSS) < 500
    assert panel.facts["Irregular"].text() == "valence 3: 8 of 8"
    assert panel.facts["Euler"].text() == "2 of 2"
    assert panel.facts["Patches"].text() == "6, conforming"
    assert panel.facts["T-junctions"].text() == "0"
    assert panel.said.text().startswith("All quads, irregular exactly where imposed")
    assert mark(panel) == GOOD
    assert panel.histogram.counts.sum() == quads.n_quads
    assert panel.verticalScrollBar().isVisibleTo(panel)
    assert panel.widget().width() <= panel.viewport().width()

    # saved as they are, all four-sided
    path = tmp_path / "cube.obj"
    window.files.save_quads(path)
    assert hand.state.message is None
    vertices, faces = quads_of(path)
    assert (vertices, len(faces)) == (quads.n_vertices, quads.n_quads)
    assert (np.bincount(faces.ravel())[1:] == 3).sum() == 8
    for suffix in (".vtk", ".ply", ".gltf", ".msh"):
        window.files.save_quads(path.with_suffix(suffix))
        assert path.with_suffix(suffix).stat().st_size > 1000
    assert pv.read(path.with_suffix(".vtk")).n_cells == quads.n_quads
    window.files.save_quads(path.with_suffix(".docx"))
    assert ".docx" in hand.said

    # other colours, from the layer's own box
    editor = window.layers_panel.editors["quads"]
    box = editor.findChild(type(panel.unit), "coloring")
    box.setCurrentIndex(1)
    box.activated.emit(1)
    assert hand.state.layers["quads"].coloring == "patch"
    assert sum(count_color(hand.picture(), color) > 100 for color in PATCHES) >= 2


def test_the_mark_is_green_only_if_nothing_is_wrong(hand: Hand) -> None:
    # irregular as imposed and none inverted, but a cube in place of a sphere
    hand.open("sphere-cube")
    panel = hand.window.quads_panel
    panel.count_box.setValue(6)
    hand.trigger("mesh")
    hand.wait(lambda: hand.state.made.quads is not None)
    assert mark(panel) == BAD
    assert panel.said.text().startswith("The area is 0.")  # which has no place


def test_sizes_before_and_the_worst_quads_after(hand: Hand) -> None:
    hand.open("disk-4")
    panel, viewport = hand.window.quads_panel, hand.window.viewport
    hand.window.docks["Quads"].raise_()
    panel.count_box.setValue(400)

    # before there are quads: the least number, the least and the largest edge, and where
    hand.wait(lambda: panel.sizes.isVisible())
    expected = hand.state.made.expected
    least, largest = expected.edges(400)
    assert panel.sizes.fewest.text() == f"{hand.state.made.fewest} quads"
    assert f"{least:.3g}" in panel.sizes.edges.text()
    panel.count_box.setValue(100)
    assert f"{2 * largest:.3g}" in panel.sizes.edges.text()
    panel.sizes.edges.linkActivated.emit("1")
    assert viewport.scene.camera.focus == pytest.approx(expected.at_largest.place)

    # after: a histogram at a glance, the edges that came of it, the worst quads to look at
    panel.count_box.setValue(400)
    hand.trigger("mesh")
    hand.wait(lambda: hand.state.made.quads is not None)
    assert not panel.sizes.isVisible()
    hand.window.resize(1440, 900)
    QApplication.processEvents()
    assert panel.histogram.visibleRegion().boundingRect() == panel.histogram.rect()
    quads, worst = hand.state.made.quads, hand.state.made.worst
    assert panel.facts["Edges"].text().startswith(f"{quads.edge_lengths.min():.3g} to ")
    assert f">{worst[0].quality:.2f}</a>" in panel.worst.text()
    panel.worst.linkActivated.emit("0")
    assert viewport.scene.camera.focus == pytest.approx(worst[0].spot.place)
    hand.window.session.looks.toggle_layer("singularities")  # beside which the worst quads are
    assert worst[0].quality > 0.8  # as it is beside a valence 3: no mark
    assert not hand.shows(MARK_WARNING, hand.place(worst[0].spot.place), reach=9, line=True)
    panel.measure.setCurrentIndex(LENGTHS)
    assert panel.histogram.counts.sum() == len(quads.edges)


def test_quads_of_an_edge_length(hand: Hand) -> None:
    hand.open("square")
    panel = hand.window.quads_panel
    assert panel.length_box.value() == pytest.approx(np.sqrt(1 / 5000), abs=1e-4)
    panel.unit.setCurrentIndex(LENGTH)
    panel.length_box.setValue(0.1)
    panel.button.click()
    hand.wait(lambda: hand.state.made.quads is not None)
    assert hand.state.made.quads.n_quads == 100
    assert panel.facts["Irregular"].text() == "none"
    assert panel.facts["Corners"].text() == "1 quad: 4 of 4"
    panel.unit.setCurrentIndex(COUNT)
    assert panel.options.edge_length is None


def test_edges_much_longer_than_the_others_are_made_shorter(hand: Hand, tmp_path: Path) -> None:
    """Of an annulus where sizes span 50, with the singularities across from each other."""
    case = json.loads(Path(path_of("annulus-pair-stretched")).read_text())
    case["singularities"][1]["position"] = [-0.75, 0, 0]
    (tmp_path / "across.json").write_text(json.dumps(case))
    hand.open(str(tmp_path / "across.json"))
    panel = hand.window.quads_panel
    panel.count_box.setValue(1500)

    def longest() -> float:
        before = hand.state.made.quads
        panel.button.click()
        hand.wait(lambda: hand.state.made.quads not in (None, before))
        assert hand.state.made.quads is not None
        return float(hand.state.made.quads.edge_lengths.max())

    bounded = longest()
    panel.ratio_box.setValue(panel.ratio_box.maximum())
    assert bounded < 0.8 * longest()


def test_an_edit_takes_the_quads_away_and_undo_brings_them_back(hand: Hand) -> None:
    hand.open("disk-4")
    hand.trigger("mesh")
    hand.wait(lambda: hand.state.made.quads is not None)
    made, panel = hand.state.made, hand.window.quads_panel
    start, end = hand.place_of(0), hand.place((0.45, 0.2, 0.0))
    hand.drag(start, end)
    hand.wait(lambda: hand.state.field is not made.of)
    assert hand.state.made.quads is None  # at once, not only on release
    assert count_color(hand.picture(), QUAD_EDGE) < 500
    assert panel.said.text() == STALE
    assert not hand.window.actions_table.by_name["save-quads"].isEnabled()
    hand.release(end)
    hand.wait(lambda: hand.state.solved)
    assert hand.state.made.quads is None
    assert hand.state.layers["quads"].visible  # to be seen again when they are made again
    hand.trigger("mesh")
    hand.wait(lambda: hand.state.made.quads is not None)
    assert hand.state.made.quads is not made.quads


def test_the_other_methods_keep_their_quads(hand: Hand) -> None:
    hand.open("disk-4")
    hand.trigger("mesh")
    hand.wait(lambda: hand.state.made.quads is not None)
    quads = hand.state.made.quads
    hand.trigger("method-aligned")
    hand.wait(lambda: hand.state.solved)
    assert hand.state.made.quads is None
    hand.trigger("method-isotropic")
    hand.wait(lambda: hand.state.solved)
    assert hand.state.made.quads is quads


def test_separatrices_follow_a_drag(hand: Hand) -> None:
    hand.open("disk-4")
    exact = hand.state.separatrices
    start, end = hand.place_of(0), hand.place((0.4, 0.35, 0.0))
    seen = []

    def watch(old: SessionState, new: SessionState) -> None:
        if new.separatrices is not old.separatrices:
            seen.append(new.separatrices)

    hand.window.session.observers.append(watch)
    hand.drag(start, end)
    hand.wait(lambda: hand.state.meshes.of is hand.state.field)  # in step when the mouse rests
    followed = hand.state.separatrices
    assert seen[-1] is followed
    assert followed is not exact
    starts = followed.points[followed.offsets[:-1]]
    dragged = hand.state.base.surface.position(hand.state.trial.placed)
    near = np.linalg.norm(starts - dragged, axis=1) < 0.1
    assert np.count_nonzero(near) == 3
    assert hand.shows(BLUE, hand.place(followed.points[len(followed.points) // 2]), line=True)
    hand.release(end)
    hand.wait(lambda: hand.state.made.settled)
    hand.window.session.observers.remove(watch)
    assert hand.state.separatrices is not followed

    # hidden, they are not traced either
    hand.window.session.looks.toggle_layer("separatrices")
    before = hand.state.meshes
    hand.drag(end, start)
    hand.wait(lambda: hand.state.field is not before.of)
    assert hand.state.meshes is before
    hand.key(Qt.Key.Key_Escape)
    hand.release(start)


def test_a_field_that_misses_a_boundary_is_refused_and_one_click_mends_it(
    hand: Hand, isotropic_plate: str
) -> None:
    hand.open(isotropic_plate)
    assert len(hand.state.made.misaligned) == 2
    places = [hand.place(place) for place in hand.state.made.misaligned]
    assert any(hand.shows(MARK_WARNING, place, reach=9, line=True) for place in places)
    assert hand.state.message is None  # drawn all the same, and nobody has asked for quads
    hand.trigger("mesh")
    hand.wait(lambda: hand.state.message is not None)
    assert hand.said.startswith("the field misses 2 boundaries")
    assert "\n" not in hand.said
    assert not hand.state.made.quads
    assert hand.window.quads_panel.said.text() == NOTHING
    offer(hand, "Solve anisotropic").click()
    hand.wait(lambda: hand.state.made.quads is not None)
    assert hand.state.message is None
    assert hand.state.method == "anisotropic"
    assert hand.state.made.quads.irregular == {5: 8}
    assert not hand.shows(MARK_WARNING)
    # undo: the isotropic field again, and none of its quads
    hand.trigger("undo")
    hand.wait(lambda: hand.state.solved)
    assert hand.state.made.quads is None
    assert len(hand.state.made.misaligned) == 2


def test_the_layout_layer_says_why_there_is_none(hand: Hand, isotropic_plate: str) -> None:
    hand.open(isotropic_plate)
    hand.window.session.looks.toggle_layer("layout")
    hand.wait(lambda: hand.state.message is not None)
    labels = [b.text() for b in hand.window.centre.message_bar.action_buttons]
    assert labels == ["Make valid", "Solve anisotropic"]
    offer(hand, "Make valid").click()
    hand.wait(lambda: hand.state.solved and hand.state.valid)
    assert hand.state.message is None
    assert hand.state.made.layout is not None
    assert hand.state.made.quads is None  # only the layout was asked for


def test_loops_that_do_not_close_on_a_closed_surface_are_mended_by_one_click(hand: Hand) -> None:
    hand.open("genus")
    hand.trigger("distribute")
    hand.wait(lambda: hand.state.solved)
    assert not hand.state.valid
    hand.trigger("mesh")
    hand.wait(lambda: hand.state.message is not None)
    assert offer(hand, "Solve anisotropic").isEnabled()
    offer(hand, "Make valid").click()
    hand.wait(lambda: hand.state.made.quads is not None)
    assert hand.state.message is None


def test_the_layout_layer_says_why_each_time_it_is_shown(hand: Hand, isotropic_plate: str) -> None:
    hand.open(isotropic_plate)
    hand.window.session.looks.toggle_layer("layout")
    hand.wait(lambda: hand.state.message is not None)
    said = hand.said
    # hidden, it has nothing to say; shown again, it has
    hand.window.session.looks.toggle_layer("layout")
    hand.wait()
    assert hand.state.message is None
    hand.window.session.looks.toggle_layer("layout")
    hand.wait()
    assert hand.state.message is not None
    assert hand.said == said
    # nor does a method in between that has a layout silence it
    hand.trigger("method-anisotropic")
    hand.wait(lambda: hand.state.made.layout is not None)
    assert hand.state.message is None
    hand.trigger("method-isotropic")
    hand.wait(lambda: hand.state.solved)
    assert hand.state.message is not None
    assert hand.said == said
    # what was asked for by hand stays as it was when the layer is hidden
    hand.trigger("mesh")
    hand.wait()
    hand.window.session.looks.toggle_layer("layout")
    hand.wait()
    assert hand.state.message is not None


def test_inverted_quads_are_saved_only_when_that_is_allowed(hand: Hand, tmp_path: Path) -> None:
    (tmp_path / "l.json").write_text(json.dumps(INVERTED))
    hand.open(tmp_path / "l.json")
    panel = hand.window.quads_panel
    panel.count_box.setValue(200)
    hand.trigger("mesh")
    hand.wait(lambda: hand.state.made.quads is not None)
    assert panel.said.text().startswith("1 inverted face")
    assert mark(panel) == BAD
    panel.worst.linkActivated.emit("0")  # the inverted one
    poor = [quad for quad in hand.state.made.worst if quad.quality < 0.5]
    assert hand.shows(MARK_WARNING, hand.place(poor[0].spot.place), reach=9, line=True)
    hand.window.files.save_quads(tmp_path / "quads.obj")
    assert "not written: 1 inverted face" in hand.said
    assert not (tmp_path / "quads.obj").exists()
    assert panel.allow_inverted.isVisibleTo(panel)
    panel.allow_inverted.click()
    hand.window.files.save_quads(tmp_path / "quads.obj")
    assert hand.state.message is None
    assert (tmp_path / "quads.obj").exists()
    hand.open("disk-4")
    assert not panel.allow_inverted.isVisibleTo(panel)


def test_quads_wished_for_one_surface_are_not_made_of_the_next(hand: Hand) -> None:
    hand.window.files.open("closed-H")
    while hand.state.document is None:
        QApplication.processEvents()
    assert not hand.state.solved
    hand.window.actions_table.by_name["mesh"].trigger()  # waits for the field
    hand.open("disk-4")
    hand.wait(lambda: hand.state.made.layout is not None)
    assert hand.state.made.quads is None


def test_stop_while_quads_are_made(hand: Hand) -> None:
    hand.open("disk-4")
    hand.window.quads_panel.count_box.setValue(100_000)
    stop = hand.window.actions_table.by_name["stop"]
    stages = []

    def stop_soon(old: SessionState, new: SessionState) -> None:
        if new.progress is not None:
            stages.append(new.progress.stage)
            if new.progress.stage == "filling the patches":
                hand.window.session.observers.remove(stop_soon)
                stop.trigger()

    hand.window.session.observers.append(stop_soon)
    hand.trigger("mesh")
    hand.wait(lambda: hand.state.message is not None)
    assert "choosing numbers of quads" in stages
    assert hand.said.startswith("Stopped")
    assert hand.state.made.quads is None
    QApplication.processEvents()
    assert hand.state.solved
    # what follows is not stopped, and the message goes
    hand.window.quads_panel.count_box.setValue(500)
    hand.trigger("mesh")
    hand.wait(lambda: hand.state.made.quads is not None)
    assert hand.state.message is None
