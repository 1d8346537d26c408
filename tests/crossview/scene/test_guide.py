"""The validity guide, asked for pixels of known colour."""

from dataclasses import replace

import numpy as np

from crossview.scene import GuideLine, SceneView, layers_named
from crossview.view.colors import condition_color
from solvers.primitives import square
from tests.crossview.scene.stage import Near, Stage

PLATE = square(16)


def straight(y: float, condition: int, strong: bool) -> GuideLine:
    """A line across the plate, in four pieces."""
    x = np.linspace(-0.5, 0.5, 5)
    points = np.stack([x, np.full(5, y), np.zeros(5)], axis=1)
    segments = np.stack([points[:-1], points[1:]], axis=1)
    return GuideLine(segments, condition_color(condition), strong)


def test_lines_have_the_colours_of_their_conditions_and_go(stage: Stage, near: Near) -> None:
    lines = (straight(0.2, 0, True), straight(0.0, 1, True), straight(-0.2, 2, False))
    layers = layers_named(("surface", "guide"))
    view = SceneView(PLATE.vertices, PLATE.faces, guide=lines, layers=layers)
    assert stage.scene.show(view)
    stage.scene.fit("xy")
    picture = stage.pixels()
    counts = [near(picture, condition_color(i)).sum() for i in range(3)]
    assert min(counts) > 100
    assert counts[0] > 1.5 * counts[2]  # what is emphasised is thicker
    assert near(stage.color_at((0.1, 0.2, 0.0)), condition_color(0))
    assert not stage.scene.show(replace(view))
    stage.scene.show(replace(view, guide=lines[1:]))
    assert near(stage.pixels(), condition_color(0)).sum() == 0
    stage.scene.show(view.with_layer("guide", visible=False))
    assert near(stage.pixels(), condition_color(1)).sum() == 0


def test_a_loop_is_drawn_in_the_colour_of_its_condition(stage: Stage, near: Near) -> None:
    loop = np.arange(17)
    view = SceneView(PLATE.vertices, PLATE.faces, loop=loop, loop_color=condition_color(3))
    stage.scene.show(view)
    stage.scene.fit("xy")
    assert near(stage.pixels(), condition_color(3)).sum() > 100
