"""A project opens as it was saved: the case, the layers, the camera, the colours, the quads."""

import json
from dataclasses import replace
from pathlib import Path

import pytest

from crossview.cases.gallery import find_case, path_of
from crossview.cases.json_values import CaseError
from crossview.cases.model import Case
from crossview.cases.project import VERSION, Project
from crossview.session.look import Look
from crossview.workflow.quads import MeshOptions
from tests.windowing import Hand


def test_a_project_opens_as_it_was_saved(hand: Hand, tmp_path: Path) -> None:
    hand.open("annulus-near")
    hand.wait(lambda: hand.state.solved)
    window, session = hand.window, hand.window.session
    session.edits.step_valence(1, 0)
    session.edits.step_valence(-1, 0)
    session.looks.color_by("aspect")
    session.looks.toggle_layer("cut")
    session.looks.set_layer("crosses", replace(hand.state.layers["crosses"], density=2.0))
    hand.wait(lambda: hand.state.solved)
    window.quads_panel.count_box.setValue(300)
    hand.trigger("mesh")
    hand.wait(lambda: hand.state.made.quads is not None)
    hand.trigger("view-yx")
    hand.trigger("projection")
    before, camera = hand.state, window.viewport.scene.camera.text
    ranges = dict(window.viewport.held.ranges)
    path = tmp_path / "mine.crossview"
    window.files.save_to(path)
    assert not hand.state.modified
    assert window.windowTitle().startswith("mine")

    hand.open("disk-4")
    session.looks.restore({})
    assert hand.state.layers["H"].visible
    hand.open(path)
    hand.wait(lambda: hand.state.made.quads is not None)
    after = hand.state
    assert dict(after.layers) == dict(before.layers)
    assert window.viewport.scene.camera.text == camera
    assert {name: window.viewport.held.ranges[name] for name in ranges} == ranges
    assert after.document.to_case() == before.document.to_case()
    assert after.made.options == before.made.options
    assert after.made.quads.n_quads == before.made.quads.n_quads
    assert not after.modified
    # saving again writes the same
    text = path.read_text()
    window.files.save()
    assert path.read_text() == text


def test_every_tool_reads_the_case_of_a_project(tmp_path: Path) -> None:
    case = Case.load(path_of("disk-4"))
    path = tmp_path / "disk.crossview"
    Project(case, Look(quads=MeshOptions(target_quads=50)).to_json()).save(path)
    assert find_case(str(path)).singularities == case.singularities
    assert Look.load(path).quads == MeshOptions(target_quads=50)


def test_a_project_of_the_case_alone_is_brought_up(tmp_path: Path) -> None:
    path = tmp_path / "old.crossview"
    path.write_text(json.dumps(Case.load(path_of("square")).to_json(tmp_path)))
    assert Project.load(path).case.surface == Case.load(path_of("square")).surface
    assert Look.load(path) == Look()


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"crossview": VERSION + 1}, "a newer crossview"),
        ({"look": {"layers": {"no": {}}}}, 'unknown key "no"'),
        ({"look": {"layers": {"H": {"opacity": 3}}}}, "expected a number from 0 to 1"),
        ({"look": {"layers": {"H": {"value_range": [2, 1]}}}}, "the smaller one"),
        ({"look": {"quads": {"target_quads": -4}}}, "quads"),
        ({"look": {"camera": 4}}, "expected a text"),
        ({"look": 3}, "expected an object"),
        ({"case": {"surfac": "disk"}}, 'unknown key "surfac"'),
    ],
)
def test_a_wrong_project_is_told_in_one_line(
    tmp_path: Path, change: dict[str, object], reason: str
) -> None:
    path = tmp_path / "wrong.crossview"
    told = {"crossview": VERSION, "case": {"surface": "disk"}, "look": {}}
    path.write_text(json.dumps(told | change))
    with pytest.raises(CaseError, match=reason) as caught:
        Look.load(path)
    assert "\n" not in str(caught.value)
    assert "wrong.crossview" in str(caught.value)
