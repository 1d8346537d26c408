"""Separatrices, marks, layout and quads on a real plotter, asked for pixels of known colour."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from crossview.scene import Marker, Polylines, Quads, SceneView, layers_named
from crossview.view.colors import (
    MARK_WARNING,
    PATCHES,
    QUAD_EDGE,
    SURFACE,
    color_table,
    rgb,
    valence_color,
)
from crossview.view.quad_geometry import QuadGeometry, spread_colors
from crossview.view.scalars import shown_scalar
from solvers.primitives import sphere, square
from tests.crossview.scene.stage import Near, Stage

PLATE = square(8)
BALL = sphere(3)


def grid(
    columns: int,
    rows: int,
    low: tuple[float, float] = (-0.5, -0.5),
    high: tuple[float, float] = (0.5, 0.5),
) -> tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.int64]]:
    """Points and quads of a planar grid, and their columns."""
    x, y = (np.linspace(a, b, n + 1) for a, b, n in zip(low, high, (columns, rows), strict=True))
    points = np.stack([*np.meshgrid(x, y, indexing="ij")], axis=-1).reshape(-1, 2)
    first = (np.arange(columns)[:, None] * (rows + 1) + np.arange(rows)).ravel()
    quads = np.stack([first, first + rows + 1, first + rows + 2, first + 1], axis=1)
    return np.column_stack([points, np.zeros(len(points))]), quads, np.repeat(range(columns), rows)


def plate_quads(columns: int = 4, rows: int = 4, **values: Any) -> Quads:
    points, quads, patch = grid(columns, rows)
    return Quads(points, quads, patch, **values)


def view(names: Sequence[str], **values: Any) -> SceneView:
    return SceneView(PLATE.vertices, PLATE.faces, layers=layers_named(names), **values)


def curves(valences: Sequence[int] = (3, 5)) -> Polylines:
    ends = np.array([[-0.4, 0.2, 0.0], [0.4, 0.2, 0.0], [-0.4, -0.2, 0.0], [0.4, -0.2, 0.0]])
    return Polylines(ends, np.array([0, 2, 4]), np.array(valences))


class TestSeparatrices:
    def test_each_has_the_colour_of_its_singularity(self, stage: Stage, near: Near) -> None:
        stage.scene.show(view(["surface", "separatrices"], separatrices=curves()))
        stage.scene.fit()
        assert near(stage.color_at((0.1, 0.2, 0.0)), valence_color(3))
        assert near(stage.color_at((0.1, -0.2, 0.0)), valence_color(5))
        # the end of one is not joined to the start of the next
        assert near(stage.color_at((0.0, 0.0, 0.0)), SURFACE)

    def test_new_curves_replace_the_old_in_the_same_actor(
        self, stage: Stage, new_stage: Callable[[], Stage]
    ) -> None:
        stage.scene.show(view(["separatrices"], separatrices=curves()))
        props = stage.props()
        shorter = Polylines(np.array([[0.0, 0, 0], [0.3, 0.3, 0]]), np.array([0, 2]), np.array([6]))
        last = view(["surface", "separatrices"], separatrices=shorter)
        stage.scene.show(last)
        stage.scene.fit()
        fresh = new_stage()
        fresh.scene.show(last)
        fresh.scene.fit()
        assert np.array_equal(stage.pixels(), fresh.pixels())
        assert stage.props() == props

    def test_a_curve_of_one_point_or_none_is_no_line(self) -> None:
        made = Polylines(np.zeros((4, 3)), np.array([0, 1, 1, 4]), np.array([3, 3, 5]))
        assert made.segments.tolist() == [[1, 2], [2, 3]]
        assert made.segment_valences.tolist() == [5, 5]


class TestMarks:
    def test_a_t_is_black_in_a_white_disc(self, stage: Stage, near: Near) -> None:
        stage.scene.show(view(["surface", "marks"], t_junctions=np.array([[0.1, 0.1, 0.0]])))
        stage.scene.fit()
        row, column = stage.where((0.1, 0.1, 0.0))
        patch = stage.pixels()[row - 9 : row + 10, column - 9 : column + 10].astype(int)
        assert patch[9, 9].max() < 60  # the stem
        assert near(patch[11, 5], "#ffffff", 8)
        assert near(patch[11, 13], "#ffffff", 8)
        assert patch[5, 6].max() < 90  # the bar
        assert patch[5, 12].max() < 90

    def test_a_missed_boundary_is_a_red_sign_of_one_size(self, stage: Stage, near: Near) -> None:
        shown = view(["surface", "marks"], misaligned=np.array([[0.5, 0.0, 0.0]]))
        stage.scene.show(shown)
        areas = []
        for height in (2.0, 4.0):
            stage.scene.fit(f"0,0,{height},0,0,0,0,1,0")
            areas.append(int(near(stage.pixels(), MARK_WARNING, 40).sum()))
        assert areas[0] > 30
        assert areas[1] == pytest.approx(areas[0], rel=0.25)
        stage.scene.show(shown.with_layer("marks", visible=False))
        assert not near(stage.pixels(), MARK_WARNING, 40).any()

    def test_behind_the_surface_it_is_hidden(self, stage: Stage, near: Near) -> None:
        layers = layers_named(["surface", "marks"])
        for z, seen in ((1.0, True), (-1.0, False)):
            place = np.array([[0.0, 0.0, z]])
            stage.scene.show(SceneView(BALL.vertices, BALL.faces, misaligned=place, layers=layers))
            stage.scene.fit("xy")
            assert near(stage.pixels(), MARK_WARNING, 40).any() == seen


class TestQuads:
    def test_they_take_the_place_of_the_triangles_and_the_crosses(
        self, stage: Stage, near: Near
    ) -> None:
        axes = [np.tile(axis, (PLATE.n_faces, 1)) for axis in np.eye(3)[:2]]
        h = PLATE.vertices[:, 0]
        values = {"H": h, "u": axes[0], "v": axes[1], "quads": plate_quads()}
        shown = view(["H", "crosses", "quads"], **values).with_layer("quads", coloring="plain")
        stage.scene.show(shown)
        stage.scene.fit()
        assert near(stage.color_at((0.36, 0.4, 0.0)), SURFACE)
        row, column = stage.where((0.25, 0.4, 0.0))
        assert near(stage.pixels()[row, column - 2 : column + 3], QUAD_EDGE, 90).any()
        actors = stage.plotter.actors
        assert not actors["surface"].GetVisibility()
        assert not actors["crosses"].GetVisibility()
        assert shown_scalar(shown) == ""
        stage.scene.show(shown.with_layer("quads", visible=False))
        assert actors["surface"].GetVisibility()
        assert actors["crosses"].GetVisibility()
        assert not near(stage.color_at((0.36, 0.4, 0.0)), SURFACE)

    def test_quality_is_sequential(self, stage: Stage) -> None:
        quality = np.repeat([0.0, 0.5, 1.0, -0.7], 4)
        shown = view(["quads"], quads=plate_quads(quality=quality))
        shown = shown.with_layer("quads", value_range=(0.0, 1.0))
        stage.scene.show(shown)
        stage.scene.fit()
        assert stage.scene.limits == (0.0, 1.0)
        table = color_table("lajolla down")[:, :3].astype(int)
        for x, row in ((-0.36, 0), (-0.14, 128), (0.11, 255), (0.36, 0)):
            assert np.abs(stage.color_at((x, 0.11, 0.0)) - table[row]).max() <= 4
        stage.scene.show(shown.with_layer("quads", value_range=(0.5, 1.0)))
        assert stage.scene.limits == (0.5, 1.0)
        assert np.abs(stage.color_at((-0.14, 0.11, 0.0)) - table[0]).max() <= 4

    def test_the_range_of_quality_is_what_occurs(self, stage: Stage) -> None:
        quality = np.linspace(0.87, 0.99, 16)
        stage.scene.show(view(["quads"], quads=plate_quads(quality=quality)))
        low, high = stage.scene.limits
        assert high == 1.0
        assert 0.8 < low <= 0.87

    def test_patches_next_to_each_other_differ(self, stage: Stage, near: Near) -> None:
        shown = view(["quads"], quads=plate_quads(5, 3)).with_layer("quads", coloring="patch")
        stage.scene.show(shown)
        stage.scene.fit()
        seen = [tuple(stage.color_at((x, 0.05, 0.0))) for x in (-0.42, -0.22, -0.02, 0.18, 0.38)]
        assert all(a != b for a, b in pairwise(seen))
        known = [np.round(255 * np.array(rgb(color))) for color in PATCHES]
        assert all(min(np.abs(color - k).max() for k in known) <= 2 for color in seen)

    def test_irregular_vertices_are_dots_in_the_colours_of_valences(
        self, stage: Stage, near: Near
    ) -> None:
        places = np.array([[0.1, 0.1, 0.0], [-0.2, 0.3, 0.0]])
        mesh = plate_quads(irregular=places, valences=np.array([3, 5]))
        stage.scene.show(view(["quads"], quads=mesh))
        stage.scene.fit()
        assert near(stage.color_at(places[0]), valence_color(3))
        assert near(stage.color_at(places[1]), valence_color(5))

    def test_without_quads_the_layer_shows_the_triangles(self, stage: Stage, near: Near) -> None:
        for mesh in (None, Quads(np.zeros((0, 3)), np.empty((0, 4), int), np.empty(0, int))):
            stage.scene.show(view(["surface", "quads"], quads=mesh))
            stage.scene.fit()
            assert near(stage.color_at((0.1, 0.07, 0.0)), SURFACE)

    def test_other_quads_show_as_in_a_fresh_scene(
        self, stage: Stage, new_stage: Callable[[], Stage]
    ) -> None:
        marker = (Marker((0.0, 0.0, 0.0), 3),)
        stage.scene.show(view(["quads"], quads=plate_quads(2, 2), singularities=marker))
        props = stage.props()
        last = view(["quads"], quads=plate_quads(5, 3, quality=np.linspace(0, 1, 15)))
        stage.scene.show(last)
        stage.scene.fit()
        fresh = new_stage()
        fresh.scene.show(last)
        fresh.scene.fit()
        assert np.array_equal(stage.pixels(), fresh.pixels())
        assert stage.props() == props


class TestLayout:
    def test_borders_are_in_ink_and_between_patches_only(self, stage: Stage, near: Near) -> None:
        shown = view(["layout"], layout=plate_quads(4, 4))
        stage.scene.show(shown)
        stage.scene.fit()
        assert near(stage.color_at((0.25, 0.1, 0.0)), "#000000")
        assert not near(stage.color_at((0.1, 0.25, 0.0)), "#000000", 60)
        stage.scene.show(shown.with_layer("layout", edges=False))
        assert not near(stage.pixels(), "#000000", 30).any()

    def test_opacity_mixes_the_patches_with_grey(self, stage: Stage, near: Near) -> None:
        shown = view(["layout"], layout=plate_quads(4, 4)).with_layer("layout", opacity=0.0)
        stage.scene.show(shown)
        stage.scene.fit()
        assert near(stage.color_at((0.1, 0.1, 0.0)), SURFACE)

    def test_a_patch_that_meets_itself_has_its_border_there(self) -> None:
        # a tube of one patch, sampled with its seam twice
        points, quads, _ = grid(12, 3)
        turn = 2 * np.pi * (points[:, 0] + 0.5)
        tube = np.stack([np.cos(turn), np.sin(turn), points[:, 1]], axis=1)
        geometry = QuadGeometry(Quads(tube, quads, np.zeros(len(quads), int), apart=True))
        assert len(geometry.borders) == 2 * 12 + 2 * 3
        assert len(geometry.merged[0]) == 12 * 4  # but it is shaded as one

    def test_colours_differ_between_neighbours_and_spread(self) -> None:
        around = np.stack([np.arange(30), (np.arange(30) + 1) % 30], axis=1)
        spokes = np.stack([np.full(30, 30), np.arange(30)], axis=1)
        pairs = np.vstack([around, spokes])
        chosen = spread_colors(31, pairs, len(PATCHES))
        assert (chosen[pairs[:, 0]] != chosen[pairs[:, 1]]).all()
        assert np.bincount(chosen[:30], minlength=len(PATCHES)).max() <= 6


def test_quads_above_the_layout(stage: Stage, near: Near) -> None:
    both = view(["layout", "quads"], quads=plate_quads(), layout=plate_quads())
    assert both.cover == "quads"
    assert both.with_layer("quads", visible=False).cover == "layout"
    assert replace(both, quads=None, layout=None).cover == ""
