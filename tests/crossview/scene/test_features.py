"""Feature edges in the scene."""

import numpy as np

from crossview.scene import SceneView, layers_named
from crossview.view.colors import FEATURE, PROBLEM
from solvers.features.dihedral import sharp_edges
from solvers.features.edges import Features
from solvers.primitives import BUILTIN
from solvers.surface.trisurface import TriSurface
from tests.crossview.scene.stage import Stage
from tests.windowing import count_color


def cube() -> TriSurface:
    sphere = BUILTIN["cube_sphere"](n=8)
    return TriSurface(sphere.vertices / np.abs(sphere.vertices).max(axis=1)[:, None], sphere.faces)


def test_features_are_drawn_and_missed_ones_differ(stage: Stage) -> None:
    surface = cube()
    edges = Features(surface, sharp_edges(surface, 40)).ends
    layers = layers_named(["surface", "features"])
    view = SceneView(surface.vertices, surface.faces, features=edges, layers=layers)
    stage.scene.show(view)
    stage.scene.fit("iso")
    picture = stage.pixels()
    assert count_color(picture, FEATURE) > 500
    assert count_color(picture, PROBLEM) == 0
    missed = SceneView(surface.vertices, surface.faces, features=edges, missed=edges, layers=layers)
    stage.scene.show(missed)
    assert count_color(stage.pixels(), PROBLEM) > 500
    stage.scene.show(view.with_layer("features", visible=False))
    picture = stage.pixels()
    assert count_color(picture, FEATURE) == count_color(picture, PROBLEM) == 0
