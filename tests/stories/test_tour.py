"""The tour goes on by what the user does, and can be left at any step."""

from crossview.gui.tour import STEPS
from tests.windowing import Hand


def test_the_tour_goes_on_by_doing_what_it_says(hand: Hand) -> None:
    tour = hand.window.centre.tour
    assert not tour.isVisible()
    hand.window.centre.empty.tour.click()
    hand.wait(lambda: hand.state.solved)
    assert tour.isVisible()
    assert tour.text.text().startswith(f"1 of {len(STEPS)}")
    place = hand.place_of(0)
    hand.drag(place, place + (hand.place_of(1) - place) * 0.1)
    assert tour.text.text().startswith("1 of")
    hand.release(place + (hand.place_of(1) - place) * 0.1)
    hand.wait(lambda: hand.state.solved)
    assert tour.text.text().startswith("2 of")
    hand.trigger("make-valid")
    hand.wait(lambda: hand.state.solved and hand.state.valid)
    assert tour.text.text().startswith("3 of")
    hand.trigger("mesh")
    hand.wait(lambda: hand.state.made.quads is not None)
    assert tour.text.text().startswith("4 of")
    assert not tour.onward.isVisible()
    tour.leave.click()
    assert not tour.isVisible()


def test_steps_can_be_passed_over_and_another_case_ends_the_tour(hand: Hand) -> None:
    hand.open("disk-4")
    tour = hand.window.centre.tour
    hand.trigger("tour")
    assert tour.isVisible()
    tour.onward.click()
    assert tour.text.text().startswith("2 of")
    hand.open("disk-4")
    assert not tour.isVisible()
