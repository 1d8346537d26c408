"""Figures of quads, separatrices and marks as vectors: drawn through the same camera, or hidden."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from crossview.export.figures import render_view
from crossview.scene import Polylines, Quads, SceneView, layers_named
from crossview.view.colors import MARK_WARNING, QUAD_EDGE, THEMES, valence_color
from solvers.primitives import sphere

BALL = sphere(3)
SIZE = (400, 300)


@pytest.fixture(scope="module")
def view() -> SceneView:
    """A ball with half a great circle on its near side and half on its far side."""
    turn = np.linspace(0.0, np.pi, 60)
    near = np.stack([np.cos(turn), np.zeros(60), np.sin(turn)], axis=1)
    points = np.vstack([near, near * [1.0, 1.0, -1.0]])
    corners = np.array([[x, y, z] for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)]) / 3**0.5
    sides = np.array(
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    )
    cube = Quads(corners, sides, np.arange(6), np.ones(6), corners, np.full(8, 3))
    poles = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]])
    return SceneView(
        BALL.vertices,
        BALL.faces,
        separatrices=Polylines(1.002 * points, np.array([0, 60, 120]), np.array([3, 5])),
        t_junctions=poles[1:],
        misaligned=poles,
        quads=cube,
        layout=cube,
        layers=layers_named(["surface", "separatrices", "marks"]),
    )


def strokes(path: Path, color: str) -> int:
    text = path.read_text()
    return sum(text.count(f"{kind}: {color}") for kind in ("stroke", "fill"))


def test_what_the_surface_hides_is_left_out(view: SceneView, tmp_path: Path) -> None:
    path = render_view(view, tmp_path / "a.svg", size=SIZE, camera="xy")
    # a run of short pieces from limb to limb
    assert strokes(path, valence_color(3)) > 40
    assert strokes(path, valence_color(5)) < 0.2 * strokes(path, valence_color(3))
    # rim and strokes of one "!"; the "T" is on the far side
    assert strokes(path, MARK_WARNING) == 3
    assert "#111317" not in path.read_text()


def test_edges_and_irregular_vertices_are_vectors(view: SceneView, tmp_path: Path) -> None:
    layers = layers_named(["quads"])
    path = render_view(
        replace(view, layers=layers), tmp_path / "a.svg", size=SIZE, camera="3,2,4,0,0,0,0,1,0"
    )
    assert strokes(path, QUAD_EDGE) == 9  # of a cube's twelve edges
    assert strokes(path, valence_color(3)) == 7
    assert path.read_text().count("<image") == 1
    assert "scaled Jacobian" in path.read_text()


def test_borders_of_patches_in_ink(view: SceneView, tmp_path: Path) -> None:
    shown = replace(view, layers=layers_named(["layout"]))
    path = render_view(shown, tmp_path / "a.svg", size=SIZE, camera="3,2,4,0,0,0,0,1,0")
    assert strokes(path, THEMES["white"].ink) >= 9
    render_view(shown, tmp_path / "a.png", size=SIZE, camera="3,2,4,0,0,0,0,1,0")
    picture = np.asarray(Image.open(tmp_path / "a.png").convert("RGB"), int)
    assert (picture.max(axis=-1) < 40).sum() > 50
