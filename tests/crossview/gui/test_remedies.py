"""Which buttons an error gets: decided by the kinds of its remedies, not by any word."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from crossview.session.message import Message, ShowWhere
from crossview.session.opening import Opening
from crossview.session.store import offered
from crossview.workflow.quads import MeshOptions
from solvers.errors import CrossviewError, SurfaceError
from solvers.layouts import LayoutError
from solvers.remedies import ANISOTROPIC, MAKE_VALID, RepairSurface, TakeLargest
from tests.pinched import pinched
from tests.windowing import Hand

FILE = Opening("bad.obj")
BAD = SurfaceError(
    "bad", "triangle 7", elements=[7], kind="faces", remedies=[RepairSurface("repair it")]
)


def kinds(
    error: CrossviewError, tried: Opening | MeshOptions | None = None, method: str = "isotropic"
) -> list[type]:
    return [type(remedy) for remedy in offered(error, tried, method)]


@pytest.mark.parametrize(
    ("error", "tried"),
    [
        (BAD, FILE),
        (SurfaceError("two pieces", remedies=[TakeLargest("choose the largest")]), FILE),
        (LayoutError("no quads", remedies=[MAKE_VALID, ANISOTROPIC]), MeshOptions()),
    ],
)
def test_other_words_make_the_same_buttons(
    error: CrossviewError, tried: Opening | MeshOptions
) -> None:
    before = kinds(error, tried)
    assert before
    error.remedies = tuple(replace(remedy, words="etwas anderes") for remedy in error.remedies)
    assert kinds(error, tried) == before


def test_words_alone_make_no_button() -> None:
    for advice in ("repair the surface", "choose the largest", "make the configuration valid"):
        assert kinds(SurfaceError("bad", advice=advice), FILE) == []


def test_only_what_can_be_done_now_is_offered() -> None:
    assert kinds(BAD, FILE) == [RepairSurface, ShowWhere]
    # repaired already: its triangles are no longer numbered as in the file
    assert kinds(BAD, replace(FILE, repair=True)) == []
    assert kinds(BAD) == []  # nothing was opened
    refused = LayoutError("no quads", remedies=[MAKE_VALID, ANISOTROPIC])
    assert kinds(refused) == [type(MAKE_VALID), type(ANISOTROPIC)]
    assert kinds(refused, method="anisotropic") == [type(MAKE_VALID)]


def test_where_it_is_wrong_is_shown_by_the_numbers_of_the_file() -> None:
    _, where = offered(BAD, FILE, "isotropic")
    assert isinstance(where, ShowWhere)
    np.testing.assert_array_equal(where.elements.faces, [7])


def test_a_verdict_in_other_words_leads_to_the_same_quads(hand: Hand) -> None:
    """The whole way: the message's buttons carry out their kinds."""
    hand.open("annulus-far")
    refused = LayoutError("?", remedies=[replace(MAKE_VALID, words="!")])
    hand.window.session.fail(refused, "mesh", MeshOptions(target_quads=300))
    (button,) = hand.window.centre.message_bar.action_buttons
    assert button.text() == "Make valid"
    button.click()
    hand.wait(lambda: hand.state.made.quads is not None)
    assert hand.state.valid


def test_quads_are_not_waited_for_after_a_stop(hand: Hand) -> None:
    """Whatever is said of it, and only then."""
    for message, waited in (
        (Message("Halt", "stop", "info", stopped=True), False),
        (Message("Stopped, as a word", "hint", "info"), True),
    ):
        hand.open("disk-4")
        hand.window.session.quad_making.wait_for(MeshOptions(target_quads=300))
        hand.window.session.update(hand.state.said(message))
        hand.window.session.solving.pursue()
        hand.wait()
        assert (hand.state.made.quads is not None) == waited


def test_a_wrong_file_is_repaired_and_its_largest_piece_taken(hand: Hand, tmp_path: Path) -> None:
    """Both at once are wrong, and are mended by one click."""
    hand.open(pinched(tmp_path / "bad.obj", "v 5 0 0", "v 6 0 0", "v 5 1 0", "f -3 -2 -1"))
    bar = hand.window.centre.message_bar
    assert bar.action_buttons[0].text() == "Repair, use the largest piece"
    bar.action_buttons[0].click()
    hand.wait()
    assert hand.state.document.surface.n_faces == 14
