"""Animations: how many pictures, what moves in them, and what cannot be one."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest
from PIL import Image, ImageSequence

import crossview
from crossview.export.films import Drag, dragged, iterations, turntable, way_to_validity
from crossview.scene import Camera
from crossview.view.geometry import Triangles
from solvers.progress import run
from tests.command_line import Crossview

SMALL = ("--size", "160x120", "--layers", "H,singularities")


def pictures(path: Path) -> list[np.ndarray]:
    with Image.open(path) as film:
        return [np.asarray(each.convert("RGB"), float) for each in ImageSequence.Iterator(film)]


@pytest.mark.parametrize("kind", ["gif", "png", "webp"])
def test_a_turntable_goes_once_around(crossview: Crossview, tmp_path: Path, kind: str) -> None:
    target = tmp_path / f"turn.{kind}"
    ran = crossview("animate", "sphere-cube", "-o", target, "--frames", 4, *SMALL)
    assert (ran.status, ran.err) == (0, "")
    shown = pictures(target)
    assert len(shown) == 4
    with Image.open(target) as film:
        assert film.info["loop"] == 0
    # the ground is as white as it is in a picture
    assert all((each[0, 0] == 255).all() for each in shown)


def test_all_cameras_of_a_turntable_are_equally_far_and_see_all() -> None:
    surface = crossview.primitives.torus(n=24)
    triangles = Triangles(surface.vertices, surface.faces)
    first = Camera((1.0, -4.0, 4.0), (0.0, 0.0, 0.0), (0.0, 0.7, 0.7))
    size = (400, 300)
    cameras = turntable(first, triangles, size, 12)
    away = np.array([np.subtract(c.position, c.focus) for c in cameras])
    distances = np.linalg.norm(away, axis=1)
    np.testing.assert_allclose(distances, distances[0])
    assert all(c.up == (0.0, 0.0, 1.0) for c in cameras)
    np.testing.assert_allclose(away.sum(axis=0)[:2], 0.0, atol=1e-9)
    for camera, back in zip(cameras, away / distances[:, None], strict=True):
        right = np.cross(camera.up, back)
        frame = np.stack([right / np.linalg.norm(right), np.cross(back, right), back])
        seen = (triangles.points - camera.position) @ frame.T
        tan = np.tan(np.radians(12.0))
        assert (np.abs(seen[:, 1]) < -seen[:, 2] * tan).all()
        assert (np.abs(seen[:, 0]) < -seen[:, 2] * tan * 4 / 3).all()


def test_iterations_lower_the_error_and_end_with_the_solution() -> None:
    problem = crossview.read("annulus-near")
    shown = run(iterations(problem))
    energies = [solution.field.energy for solution in shown]
    assert len(energies) >= 4
    assert energies[-1] < 1e-10 < energies[0]
    with pytest.raises(crossview.CrossviewError, match="does not iterate"):
        run(iterations(crossview.read("disk-4")))


def test_a_way_to_validity_begins_where_it_was_and_ends_valid() -> None:
    problem = crossview.read("annulus-pair")
    shown = run(way_to_validity(problem))
    assert shown[0].problem.singularities == problem.singularities
    assert not shown[0].valid
    assert shown[-1].valid


def test_a_drag_takes_one_singularity_along_and_leaves_the_others() -> None:
    problem = crossview.read("disk-4")
    shown = run(dragged(problem, Drag(2, [(0.0, 0.2, 0.0), (0.3, 0.2, 0.0)], 5)))
    places = np.array(
        [problem.surface.positions([s.point for s in each.problem.singularities]) for each in shown]
    )
    assert np.ptp(places[:, [0, 2, 3]], axis=0).max() == 0.0
    np.testing.assert_allclose(places[0, 1], [0.0, 0.55, 0.0], atol=1e-6)
    np.testing.assert_allclose(places[-1, 1], [0.3, 0.2, 0.0], atol=1e-6)
    steps = np.linalg.norm(np.diff(places[:, 1], axis=0), axis=1)
    assert steps.max() < 0.65 / 4 + 1e-6


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["-o", "turn.avi"], "unknown kind of animation"),
        (["-o", "turn.gif", "--turntable", "--make-valid"], "one thing moves at a time"),
        (["-o", "turn.gif", "--fps", "400"], "cannot show 400 pictures in a second"),
        (["-o", "turn.gif", "--drag", "1"], 'no way "1"'),
        (["-o", "turn.gif", "--drag", "7: 0,0,0"], "there is no singularity 7 (of 4)"),
        (["-o", "turn.gif", "--frames", "1"], "--frames"),
        (["-o", "turn.gif", "--iterations"], "the method isotropic does not iterate"),
        (
            ["-o", "turn.gif", "--set", "crosses.length=2"],
            "crosses has no such setting (--set crosses.length)",
        ),
    ],
)
def test_what_cannot_be_animated_is_told_in_one_line(
    crossview: Crossview, tmp_path: Path, options: list[str], said: str
) -> None:
    options = [str(tmp_path / word) if word.startswith("turn.") else word for word in options]
    ran = crossview("animate", "disk-4", *options)
    assert (ran.status, ran.err.count("\n")) == (2, 1)
    assert said in ran.err
    assert list(tmp_path.iterdir()) == []


def test_an_mp4_is_made_by_the_program_of_the_user(crossview: Crossview, tmp_path: Path) -> None:
    target = tmp_path / "turn.mp4"
    ran = crossview("animate", "disk-4", "-o", target, "--frames", 3, *SMALL)
    if shutil.which("ffmpeg") is None:
        assert ran.status == 2
        assert "made by the program ffmpeg, which is not here" in ran.err
    else:
        assert (ran.status, ran.err) == (0, "")
        assert target.read_bytes()[4:8] == b"ftyp"
