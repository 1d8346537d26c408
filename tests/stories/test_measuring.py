"""Distances and angles are measured on the surface by clicks."""

import math

import numpy as np
import pytest
from PySide6.QtCore import Qt

from crossview.session.hand import SelectTool
from crossview.session.pictures import figure_view, scene_view
from crossview.view.colors import LOOP
from tests.windowing import Hand


def said(hand: Hand) -> str:
    measurement = scene_view(hand.state).measurement
    assert measurement is not None
    return measurement.text


def test_two_clicks_measure_a_distance_and_a_third_the_angle(hand: Hand) -> None:
    hand.open("disk-4")
    hand.key(Qt.Key.Key_D)
    assert said(hand) == "Measure: click where from"
    camera = hand.window.viewport.scene.camera.text
    hand.click(hand.place((0.0, 0.0, 0.0)))
    assert said(hand) == "Measure: click where to"
    hand.click(hand.place((0.6, 0.0, 0.0)))
    hand.wait()
    (path,) = hand.state.measure_tool.paths
    straight = math.dist(path[0], path[-1])
    assert straight == pytest.approx(0.6, abs=0.01)
    assert said(hand) == f"{straight:.4g} along the surface, {straight:.4g} straight"
    assert hand.shows(LOOP, hand.place((0.3, 0.0, 0.0)), line=True)
    hand.click(hand.place((0.6, 0.4, 0.0)))
    hand.wait()
    assert "at an angle of" in said(hand)
    angle = float(said(hand).rsplit(" ", 1)[1].rstrip("°"))
    assert angle == pytest.approx(90.0, abs=2.0)
    hand.click(hand.place((-0.5, 0.0, 0.0)))  # begins anew
    assert said(hand) == "Measure: click where to"
    assert not hand.shows(LOOP, hand.place((0.3, 0.0, 0.0)), line=True)
    assert hand.window.viewport.scene.camera.text == camera
    assert figure_view(hand.state, False).measurement is None
    hand.key(Qt.Key.Key_Escape)
    assert isinstance(hand.state.tool, SelectTool)
    assert scene_view(hand.state).measurement is None
    assert not hand.shows(LOOP)


def test_a_click_on_a_singularity_measures_from_it_and_changes_nothing(hand: Hand) -> None:
    hand.open("sphere-cube")
    hand.trigger("view-xy")
    before = hand.state.document
    at = np.asarray(before.surface.positions([s.point for s in before.singularities]))
    one, other = np.flatnonzero(at[:, 2] > 0)[:2]
    hand.trigger("measure")
    hand.click(hand.place_of(int(one)))
    hand.click(hand.place_of(int(other)))
    hand.wait()
    places = hand.state.measure_tool.places
    np.testing.assert_allclose(before.surface.positions(places), at[[one, other]])
    (path,) = hand.state.measure_tool.paths
    along = np.linalg.norm(np.diff(path, axis=0), axis=1).sum()
    radius = np.linalg.norm(at[one])
    angle = math.acos(float(at[one] @ at[other]) / radius**2)
    assert along == pytest.approx(radius * angle, rel=5e-3)
    assert hand.state.document is before
    assert hand.state.focus.all == ()
    hand.open("disk-4")  # what was measured is not of it
    assert isinstance(hand.state.tool, SelectTool)
