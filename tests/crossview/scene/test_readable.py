"""Colours can be read off the bar, and signs are whole wherever their place is seen."""

from dataclasses import replace

import numpy as np
import pytest

from crossview.scene import Marker, SceneView, layers_named
from crossview.view.colors import color_table, valence_color
from solvers.primitives import sphere, torus
from tests.crossview.scene.stage import Near, Stage

BALL = sphere(subdivisions=4)


def ball_view(layers: list[str], **values: object) -> SceneView:
    return SceneView(BALL.vertices, BALL.faces, layers=layers_named(layers), **values)  # type: ignore[arg-type]


def off_the_bar(stage: Stage) -> int:
    """Pixels of the ball, its edge left out, whose colour is not on the bar of H."""
    row, column = stage.where((0.0, 0.0, 0.0))
    reach = abs(stage.where((0.0, 0.95, 0.0))[0] - row)
    rows, columns = np.mgrid[: stage.pixels().shape[0], : stage.pixels().shape[1]]
    inside = (rows - row) ** 2 + (columns - column) ** 2 < reach**2
    seen = np.unique(stage.pixels()[inside].astype(int), axis=0)
    table = color_table("vik")[:, :3].astype(int)
    away = np.abs(seen[:, None] - table[None]).max(axis=2).min(axis=1)
    return int((away > 4).sum())


def test_every_colour_of_a_scalar_is_on_the_bar_unless_it_is_shaded(stage: Stage) -> None:
    view = ball_view(["H"], H=BALL.vertices[:, 0])
    stage.scene.show(view)
    stage.scene.fit("xy")
    assert off_the_bar(stage) == 0
    stage.scene.show(view.with_layer("H", shaded=True))
    assert off_the_bar(stage) > 100


@pytest.mark.parametrize("camera", ["xy", "iso"])
def test_a_disc_at_the_silhouette_is_as_whole_as_one_that_faces_the_eye(
    stage: Stage, near: Near, camera: str
) -> None:
    view = ball_view(["surface", "singularities"])
    stage.scene.show(view)
    stage.scene.fit(camera)
    back = np.subtract(stage.scene.camera.position, stage.scene.camera.focus)
    back /= np.linalg.norm(back)
    side = np.cross(back, stage.scene.camera.up)
    side /= np.linalg.norm(side)

    def seen(place: np.ndarray) -> int:
        x, y, z = (float(part) for part in place)
        marker = Marker((x, y, z), 3, normal=(x, y, z))
        stage.scene.show(replace(view, singularities=(marker,)))
        return int(near(stage.pixels(), valence_color(3)).sum())

    def size(place: np.ndarray) -> float:
        away = float(np.linalg.norm(place - stage.scene.camera.position))
        return 1.0 if camera == "xy" else away**-2

    facing = seen(back)
    assert facing > 50
    for degrees in (30.0, 60.0, 75.0):
        turn = np.radians(degrees)
        place = np.cos(turn) * back + np.sin(turn) * side
        assert seen(place) > 0.9 * facing * size(place) / size(back)
    assert seen(-0.3 * back + 0.95 * side) == 0  # beyond the silhouette, by less than its radius
    assert seen(-back) == 0
    assert seen(-0.5 * back + 0.87 * side) == 0


def test_about_the_silhouette_a_disc_is_shown_or_not_and_never_torn(
    stage: Stage, near: Near
) -> None:
    view = ball_view(["surface", "singularities"])
    stage.scene.show(view)
    stage.scene.fit("iso")
    back = np.subtract(stage.scene.camera.position, stage.scene.camera.focus)
    back /= np.linalg.norm(back)
    side = np.cross(back, stage.scene.camera.up)
    side /= np.linalg.norm(side)
    shown = []
    for turn in np.radians(np.arange(60.0, 100.0, 1.0)):
        x, y, z = np.cos(turn) * back + np.sin(turn) * side
        marker = Marker((x, y, z), 3, normal=(x, y, z))
        stage.scene.show(replace(view, singularities=(marker,)))
        places = np.argwhere(near(stage.pixels(), valence_color(3)))
        assert not len(places) or np.abs(places - stage.where((x, y, z))).max() < 12
        shown.append(len(places) > 0)
    assert shown[0]
    assert not shown[-1]


def test_what_faces_the_eye_behind_something_else_stays_hidden(stage: Stage, near: Near) -> None:
    surface = torus()
    stage.scene.show(SceneView(surface.vertices, surface.faces, layers=layers_named(["surface"])))
    stage.scene.fit("xz")  # from the front, along y
    # on the wall beyond the hole, which looks at the eye through the tube in front
    wall = min(
        (v for v in surface.vertices if v[1] > 0.1 and abs(v[0]) < 0.1 and abs(v[2]) < 0.05),
        key=lambda v: float(v[1]),
    )
    x, y, z = (float(part) for part in wall)
    marker = Marker((x, y, z), 3, normal=(0.0, -1.0, 0.0))
    view = SceneView(
        surface.vertices,
        surface.faces,
        layers=layers_named(["surface", "singularities"]),
        singularities=(marker,),
    )
    stage.scene.show(view)
    assert not near(stage.pixels(), valence_color(3)).any()
