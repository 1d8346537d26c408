"""A plane cuts away what is nearer to the eye."""

import numpy as np
from PySide6.QtCore import Qt

from crossview.session.pictures import figure_view
from crossview.view.colors import valence_color
from tests.windowing import Hand


def test_the_nearer_half_is_cut_away_and_what_is_inside_is_seen_and_picked(hand: Hand) -> None:
    hand.open("sphere-cube")
    hand.trigger("view-xy")
    surface = hand.state.document.surface
    at = np.asarray(surface.positions([s.point for s in hand.state.singularities]))
    middle = hand.place((0.0, 0.0, 0.0))
    far = int(np.flatnonzero(at[:, 2] < 0)[0])
    assert hand.window.viewport.pick(middle).position[2] > 0.9
    seen = hand.window.viewport.singularity_at(hand.place_of(far))
    assert seen is None or at[seen, 2] > 0
    hand.key(Qt.Key.Key_X)
    hand.wait()
    assert hand.window.viewport.pick(middle).position[2] < -0.9
    assert hand.window.viewport.singularity_at(hand.place_of(far)) == far
    assert hand.shows(valence_color(3), hand.place_of(far), reach=2)
    near = {i for i in range(8) if at[i, 2] > 0}
    assert all(hand.window.viewport.singularity_at(hand.place_of(i)) not in near for i in near)
    hand.click(hand.place_of(far))
    assert hand.state.focus.selected == far
    for _ in range(40):
        hand.key(Qt.Key.Key_PageUp)
    assert hand.window.viewport.pick(middle).position[2] > 0.9  # beyond the surface
    for _ in range(80):
        hand.key(Qt.Key.Key_PageDown)
    assert hand.window.viewport.pick(middle) is None
    assert not hand.shows(valence_color(3), hand.place_of(far), reach=2)
    assert figure_view(hand.state, False).clip is None
    hand.key(Qt.Key.Key_X)
    assert hand.window.viewport.pick(middle).position[2] > 0.9
    hand.key(Qt.Key.Key_X)
    hand.open("disk-4")
    assert hand.state.clip is None
