"""The scene on a real plotter, asked for pixels of known colour."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from cmcrameri import cm

from crossview.scene import Elements, Marker, SceneView, layers_named
from crossview.view.colors import (
    CROSS,
    CUT,
    LOOP,
    PROBLEM,
    SURFACE,
    THEMES,
    color_table,
    valence_color,
)
from crossview.view.scalars import bar_texts
from solvers.errors import CrossviewError
from solvers.primitives import annulus, sphere, square
from tests.crossview.scene.stage import Near, Stage

PLATE = square(16)
BALL = sphere(3)


def plate_view(names: Sequence[str] = ("surface",), **values: Any) -> SceneView:
    return SceneView(PLATE.vertices, PLATE.faces, layers=layers_named(names), **values)


def ball_view(turn: float = 0.0, **values: Any) -> SceneView:
    """A ball with a field that turns about z."""
    n = BALL.face_normals
    axis = np.array([np.cos(turn), np.sin(turn), 0.3])
    u = np.cross(n, axis)
    u /= np.linalg.norm(u, axis=1)[:, None]
    return SceneView(
        BALL.vertices, BALL.faces, H=BALL.vertices @ axis, u=u, v=np.cross(n, u), **values
    )


class TestWhatIsSeen:
    def test_a_plain_surface_from_above_is_its_grey(self, stage: Stage, near: Near) -> None:
        stage.scene.show(plate_view())
        stage.scene.fit()
        assert near(stage.color_at((0.2, 0.1, 0.0)), SURFACE)

    def test_background_follows_the_theme(self, stage: Stage, near: Near) -> None:
        for name in ("white", "dark"):
            stage.scene.show(plate_view(background=name))
            stage.scene.fit()
            assert near(stage.pixels()[0, 0], THEMES[name].background)

    @pytest.mark.parametrize("valence", [1, 2, 3, 5, 6, 7, 8, 12])
    def test_a_singularity_has_the_colour_of_its_valence(
        self, stage: Stage, near: Near, valence: int
    ) -> None:
        place = (0.25, -0.3, 0.0)
        stage.scene.show(
            plate_view(["surface", "singularities"], singularities=(Marker(place, valence),))
        )
        stage.scene.fit()
        assert near(stage.color_at(place), valence_color(valence))

    def test_valences_differ_in_colour(self) -> None:
        assert len({valence_color(n) for n in range(1, 13)}) == 12

    def test_h_is_diverging_about_zero(self, stage: Stage) -> None:
        h = PLATE.vertices[:, 0]
        view = plate_view(["H"], H=h).with_layer("H", value_range=(-0.5, 0.5))
        stage.scene.show(view)
        stage.scene.fit()
        for x in (-0.25, 0.0, 0.25):
            wanted = 255.0 * np.array(cm.vik(0.07 + 0.86 * (x + 0.5))[:3])
            assert np.abs(stage.color_at((x, 0.02, 0.0)) - wanted).max() <= 6

    def test_one_size_shows_as_two_equal_ones(self, stage: Stage) -> None:
        h = PLATE.vertices[:, 0]
        half = np.zeros((PLATE.n_faces, 3))
        values = {"H": h, "half_log_aspect": half}
        colors = []
        for name in ("H", "H1", "H2"):
            view = plate_view([name], **values).with_layer(name, value_range=(-0.5, 0.5))
            stage.scene.show(view)
            stage.scene.fit()
            colors.append(stage.color_at((0.25, 0.02, 0.0)))
        # of a vertex each, or of the triangle around
        assert np.abs(np.array(colors) - colors[0]).max() <= 15
        assert np.abs(colors[1] - colors[2]).max() == 0

    def test_two_sizes_differ_by_the_aspect_and_share_one_range(self, stage: Stage) -> None:
        half = np.full((PLATE.n_faces, 3), 0.3)
        values = {"H": np.full(PLATE.n_vertices, 0.1), "half_log_aspect": half}
        limits = {}
        for name, value in (("H1", -0.2), ("H2", 0.4), ("aspect", 0.6)):
            stage.scene.show(plate_view([name], **values))
            stage.scene.fit()
            limits[name] = low, high = stage.scene.limits
            table = color_table("lajolla" if name == "aspect" else "vik")
            wanted = table[round(255 * (value - low) / (high - low)), :3].astype(int)
            assert np.abs(stage.color_at((0.25, 0.02, 0.0)) - wanted).max() <= 6
        assert limits["H1"] == limits["H2"] == pytest.approx((-0.4, 0.4))
        assert limits["aspect"] == pytest.approx((0.0, 0.6))

    def test_the_error_is_shown_by_powers_of_ten(self, stage: Stage) -> None:
        left = PLATE.barycentres[:, 0] < 0
        view = plate_view(["error"], error_density=np.where(left, 1e-2, 10.0))
        stage.scene.show(view)
        stage.scene.fit()
        assert stage.scene.limits == (-3, 1)
        table = color_table("lajolla")[:, :3].astype(int)
        for x, row in ((-0.25, 64), (0.25, 255)):
            assert np.abs(stage.color_at((x, 0.02, 0.0)) - table[row]).max() <= 6
        assert bar_texts("error", (-3, 1)) == ["10⁻³", "10⁻²", "10⁻¹", "10⁰", "10¹"]
        # where it is only rounding nothing stands out; a given range serves two pictures
        stage.scene.show(plate_view(["error"], error_density=np.full(PLATE.n_faces, 1e-29)))
        assert np.abs(stage.color_at((0.25, 0.02, 0.0)) - table[0]).max() <= 6
        stage.scene.show(view.with_layer("error", value_range=(-6.0, 2.0)))
        assert stage.scene.limits == (-6, 2)

    def test_h_range_is_round_symmetric_and_not_led_by_poles(self, stage: Stage) -> None:
        h = np.where(np.arange(PLATE.n_vertices) == 100, -50.0, 1.5 * PLATE.vertices[:, 0])
        stage.scene.show(plate_view(["H"], H=h))
        low, high = stage.scene.h_range
        assert low == -high
        assert high == pytest.approx(0.8)
        # that there are deeper ones is told at the foot of the bar
        assert stage.scene.beyond == (True, False)
        assert bar_texts("H", (low, high), stage.scene.beyond)[0] == "≤ −0.80"
        assert bar_texts("H", (low, high), stage.scene.beyond)[-1] == "0.80"
        stage.scene.show(plate_view(["H"], H=0.4 * PLATE.vertices[:, 0]))
        assert stage.scene.beyond == (False, False)

    def test_crosses_are_drawn_where_the_triangles_are_and_nowhere_else(
        self, stage: Stage, near: Near
    ) -> None:
        e = (
            np.tile([1.0, 0.0, 0.0], (PLATE.n_faces, 1)),
            np.tile([0.0, 1.0, 0.0], (PLATE.n_faces, 1)),
        )
        for names, seen in ((["surface", "crosses"], True), (["surface"], False)):
            stage.scene.show(plate_view(names, u=e[0], v=e[1]))
            stage.scene.fit()
            dark = near(stage.pixels(), CROSS, 12)
            assert (dark.sum() > 1000) == seen
            if seen:
                rows, columns = np.nonzero(dark)
                bottom, left = stage.where((-0.5, -0.5, 0.0))
                top, right = stage.where((0.5, 0.5, 0.0))
                assert top <= rows.min() <= rows.max() <= bottom
                assert left <= columns.min() <= columns.max() <= right

    def test_the_far_side_of_a_ball_is_hidden(self, stage: Stage, near: Near) -> None:
        hidden, seen = Marker((0.0, 0.0, -1.0), 5), Marker((0.0, 0.0, 1.0), 3)
        layers = layers_named(["surface", "singularities"])
        stage.scene.show(
            SceneView(BALL.vertices, BALL.faces, singularities=(hidden, seen), layers=layers)
        )
        stage.scene.fit("xy")
        pixels = stage.pixels()
        assert near(pixels, valence_color(3)).sum() > 20
        assert not near(pixels, valence_color(5)).any()

    def test_the_cut_is_dashed(self, stage: Stage, near: Near) -> None:
        row = np.flatnonzero(np.isclose(PLATE.vertices[:, 1], 0.0))
        row = row[np.argsort(PLATE.vertices[row, 0])]
        stage.scene.show(plate_view(["surface", "cut"], cut_graph=np.stack([row[:-1], row[1:]], 1)))
        stage.scene.fit()
        line, start = stage.where((-0.5, 0.0, 0.0))
        _, stop = stage.where((0.5, 0.0, 0.0))
        blue = near(stage.pixels()[line, start:stop], CUT)
        assert 0.4 < blue.mean() < 0.8
        assert np.count_nonzero(np.diff(blue.astype(int)) == 1) > 20

    def test_boundary_loop_and_problem(self, stage: Stage, near: Near) -> None:
        ring = annulus(n=48)
        view = SceneView(
            ring.vertices,
            ring.faces,
            loop=ring.boundary_loops[1],
            problem=Elements(faces=np.array([7])),
            layers=layers_named(["surface", "boundary"]),
        )
        stage.scene.show(view)
        stage.scene.fit()
        pixels = stage.pixels()
        assert near(pixels, "#000000").sum() > 200
        assert near(pixels, LOOP).sum() > 200
        assert near(stage.color_at(ring.barycentres[7]), PROBLEM)
        stage.scene.show(replace(view, loop=None, problem=None))
        assert not near(stage.pixels(), LOOP).any()
        assert not near(stage.pixels(), PROBLEM).any()

    def test_problem_vertices_and_edges(self, stage: Stage, near: Near) -> None:
        problem = Elements(vertices=np.array([40]), edges=PLATE.edges[200:201])
        stage.scene.show(plate_view(problem=problem))
        stage.scene.fit()
        assert near(stage.color_at(PLATE.vertices[40]), PROBLEM)
        assert near(stage.color_at(PLATE.vertices[PLATE.edges[200]].mean(axis=0)), PROBLEM)

    def test_the_legend_names_the_valences_present(self, stage: Stage, near: Near) -> None:
        markers = (Marker((0.2, 0.2, 0.0), 3), Marker((0.7, 0.7, 0.0), 6))
        stage.scene.show(plate_view(["surface", "singularities", "legend"], singularities=markers))
        stage.scene.fit()
        corner = stage.pixels()[-40:, :200]
        assert near(corner, valence_color(3)).sum() > 50
        assert near(corner, valence_color(6)).sum() > 50
        assert not near(corner, valence_color(5)).any()


class TestHowItChanges:
    def test_a_drag_in_place_ends_in_the_picture_of_a_fresh_scene(
        self, stage: Stage, new_stage: Callable[[], Stage]
    ) -> None:
        marker = Marker((0.0, 0.0, 1.0), 3)
        for turn in (0.0, 0.4, 0.9):
            moved = replace(marker, position=(np.sin(turn), 0.0, np.cos(turn)))
            last = ball_view(turn, singularities=(moved,), title="drag")
            stage.scene.show(last)
        stage.scene.fit()
        fresh = new_stage()
        fresh.scene.show(last)
        fresh.scene.fit()
        assert np.array_equal(stage.pixels(), fresh.pixels())

    def test_another_surface_shows_as_in_a_fresh_scene(
        self, stage: Stage, new_stage: Callable[[], Stage]
    ) -> None:
        stage.scene.show(ball_view(singularities=(Marker((0.0, 0.0, 1.0), 3),)))
        last = plate_view(["surface", "boundary", "H"], H=PLATE.vertices[:, 1])
        stage.scene.show(last)
        stage.scene.fit()
        fresh = new_stage()
        fresh.scene.show(last)
        fresh.scene.fit()
        assert np.array_equal(stage.pixels(), fresh.pixels())

    def test_nothing_is_added_however_often_it_changes(self, stage: Stage) -> None:
        stage.scene.show(
            ball_view(singularities=(Marker((0.0, 0.0, 1.0), 3), Marker((0.0, 1.0, 0.0), 5)))
        )
        before = stage.props()
        for turn in np.linspace(0.0, 1.0, 12):
            stage.scene.show(
                ball_view(turn, title=str(turn)).with_layer("theta", visible=turn > 0.5)
            )
            stage.scene.show(
                plate_view(["surface", "legend"], singularities=(Marker((0, 0, 0), 3),))
            )
            stage.pixels()
        assert stage.props() == before

    def test_an_equal_view_is_no_change(self, stage: Stage) -> None:
        view = ball_view()
        assert stage.scene.show(view)
        assert not stage.scene.show(replace(view))
        assert stage.scene.show(replace(view, title="other"))

    def test_what_did_not_change_is_not_touched(self, stage: Stage) -> None:
        view = ball_view(singularities=(Marker((0.0, 0.0, 1.0), 3),))
        stage.scene.show(view)
        meshes = [
            stage.plotter.actors[name].GetMapper().GetInput() for name in ("surface", "crosses")
        ]
        before = [mesh.GetMTime() for mesh in meshes]
        stage.scene.show(replace(view, singularities=(Marker((0.0, 1.0, 0.0), 5),)))
        assert [mesh.GetMTime() for mesh in meshes] == before

    def test_smoothing_blends_the_edges_and_can_be_taken_back(
        self, stage: Stage, near: Near
    ) -> None:
        stage.scene.show(plate_view(["boundary", "surface"]))
        stage.scene.fit("0.3,0.2,3,0,0,0,0.3,1,0")
        plain = stage.pixels()
        stage.scene.smooth(True)
        smoothed = stage.pixels()
        stage.scene.smooth(False)
        shades = [len(np.unique(pixels.reshape(-1, 3), axis=0)) for pixels in (plain, smoothed)]
        assert shades[1] > 3 * shades[0]
        assert np.array_equal(stage.pixels(), plain)

    def test_the_colour_bar_stays_where_it_is(self, stage: Stage) -> None:
        stage.scene.show(ball_view().with_layer("H", value_range=(-1.0, 1.0)))
        stage.scene.fit()
        bar = stage.pixels()[-200:, -34:]
        stage.scene.show(ball_view(1.0, singularities=(Marker((0.0, 0.0, 1.0), 3),)))
        assert np.array_equal(stage.pixels()[-200:, -34:], bar)

    def test_remove_leaves_nothing_behind(self, stage: Stage) -> None:
        stage.scene.show(ball_view(singularities=(Marker((0.0, 0.0, 1.0), 3),), title="going"))
        stage.scene.remove()
        assert stage.props() == []
        assert not stage.plotter.renderer.HasObserver("StartEvent")


class TestWhatCannotBeDrawn:
    def test_a_broken_surface_is_shown_as_far_as_it_goes(self, stage: Stage, near: Near) -> None:
        points = np.vstack([PLATE.vertices, [[np.nan, 0.0, 0.0]]])
        faces = np.vstack([PLATE.faces, [[0, 1, len(points) + 7], [0, 1, len(points) - 1]]])
        view = SceneView(points, faces, problem=Elements(faces=np.array([3, len(faces) - 1])))
        stage.scene.show(view)
        stage.scene.fit()
        assert near(stage.color_at(PLATE.barycentres[3]), PROBLEM)

    def test_an_unknown_layer_names_the_known(self) -> None:
        with pytest.raises(CrossviewError, match=r'no layer "hexes".*surface, H, theta, .*crosses'):
            layers_named(["H", "hexes"])
