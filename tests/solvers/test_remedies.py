"""What an error says is to be done, and what a program makes of it."""

import pickle
from dataclasses import replace

import numpy as np
import pytest

from solvers.errors import CrossviewError, SurfaceError
from solvers.layouts.errors import LayoutError
from solvers.remedies import ANISOTROPIC, MAKE_VALID, Remedy, RepairSurface
from solvers.surface.validation import problems
from solvers.validity.attempts import PlaceAnew, ValidityError
from tests.solvers.suite import SURFACES


@pytest.mark.parametrize(
    ("error", "line"),
    [
        (CrossviewError("it fails"), "it fails"),
        (CrossviewError("it fails", "here"), "it fails (here)"),
        (CrossviewError("it fails", "here", "go away"), "it fails (here): go away"),
        (
            CrossviewError("it fails", remedies=[MAKE_VALID, ANISOTROPIC]),
            "it fails: make the configuration valid or solve the anisotropic field",
        ),
        (
            SurfaceError("it fails", "here", "go away", remedies=[RepairSurface("repair it")]),
            "it fails (here): go away, or repair it",
        ),
    ],
)
def test_an_error_is_one_line_of_what_where_and_what_to_do(
    error: CrossviewError, line: str
) -> None:
    assert str(error) == line


def test_a_command_may_be_told_with_each_remedy() -> None:
    error = CrossviewError("it fails", remedies=[MAKE_VALID, ANISOTROPIC])
    assert error.line(lambda remedy: type(remedy).__name__) == "it fails: MakeValid or UseMethod"


def test_where_it_is_wrong_is_told_from_the_outside_in() -> None:
    error = CrossviewError("it fails", "triangle 7")
    error.locate("bad.obj")
    error.locate("component 2")
    assert str(error) == "it fails (component 2, bad.obj, triangle 7)"
    bare = CrossviewError("it fails")
    bare.locate("bad.obj")
    assert str(bare) == "it fails (bad.obj)"


def test_a_button_says_what_to_do_whatever_the_words_in_the_line() -> None:
    assert Remedy("turn it over").label == "Turn it over"
    for remedy in (MAKE_VALID, ANISOTROPIC, RepairSurface("repair it")):
        assert replace(remedy, words="do something else").label == remedy.label


def test_what_repair_mends_says_so_by_its_kind() -> None:
    """Each kind of bad triangle: twice the same, without area, turned against its neighbour."""
    surface = SURFACES["disk"]()
    vertices, faces = surface.vertices, surface.faces
    for bad in (
        [*faces, faces[0]],
        [*faces, [0, 0, 1]],
        [faces[0][::-1], *faces[1:]],
    ):
        for problem in problems(vertices, np.array(bad)):
            assert [type(remedy) for remedy in problem.remedies] == [RepairSurface]


def test_errors_come_whole_from_other_processes() -> None:
    """As those of a batch: what is raised there is pickled."""
    place = PlaceAnew("move", (), "another layout")
    for error in (
        CrossviewError("it fails", "here", "go away", remedies=[MAKE_VALID]),
        SurfaceError("it fails", elements=[7], kind="faces", remedies=[RepairSurface("repair it")]),
        LayoutError("it fails", faces=np.array([3]), remedies=[ANISOTROPIC]),
        ValidityError("it fails", "here", "", 2, [place]),
    ):
        again = pickle.loads(pickle.dumps(error))
        assert type(again) is type(error)
        assert str(again) == str(error)
        assert vars(again).keys() == vars(error).keys()
        assert again.remedies == error.remedies
    assert again.condition == 2
