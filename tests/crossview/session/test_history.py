import pytest

from crossview.cases.model import Case
from crossview.session.commands import (
    AddSingularities,
    ChangeValence,
    Command,
    LockSingularity,
    MoveSingularity,
    RemoveSingularities,
    next_valence,
)
from crossview.session.document import Document
from crossview.session.history import History
from solvers.singularities import Singularity
from solvers.surface import SurfacePoint

CENTRE = (1 / 3, 1 / 3, 1 / 3)


@pytest.fixture(scope="module")
def document() -> Document:
    return Document.from_case(
        "disk", Case.from_json({"surface": {"builtin": "disk"}, "singularities": []})
    )


@pytest.fixture
def history(document: Document) -> History:
    history = History()
    history.open(document)
    return history


def singularity(face: int, valence: int = 3) -> Singularity:
    return Singularity(SurfacePoint(face, CENTRE), valence)


def test_every_command_comes_back_and_again(history: History) -> None:
    commands: list[Command] = [
        AddSingularities((singularity(3),)),
        AddSingularities((singularity(9, 5), singularity(12))),
        MoveSingularity(1, SurfacePoint(20, CENTRE)),
        ChangeValence(0, 6),
        LockSingularity(2, locked=True),
        RemoveSingularities(frozenset({0, 2})),
    ]
    states = [history.document]
    for command in commands:
        history.do(command)
        states.append(history.document)
    assert history.document.singularities == (Singularity(SurfacePoint(20, CENTRE), 5),)
    for command, before in zip(reversed(commands), reversed(states[:-1]), strict=True):
        assert history.undo_name == command.name
        history.undo()
        assert history.document is before
    for command, after in zip(commands, states[1:], strict=True):
        assert history.redo_name == command.name
        history.redo()
        assert history.document is after
    assert history.redo_name is None


def test_names_say_what_a_step_was() -> None:
    assert AddSingularities((singularity(1),)).name == "add valence 3"
    assert MoveSingularity(2, SurfacePoint(0, CENTRE)).name == "move singularity 3"
    assert ChangeValence(0, 5).name == "make singularity 1 a valence 5"
    assert LockSingularity(0, locked=False).name == "unlock singularity 1"
    assert RemoveSingularities(frozenset({3})).name == "delete singularity 4"
    assert RemoveSingularities(frozenset({3, 4})).name == "delete 2 singularities"


def test_a_new_step_forgets_what_was_undone(history: History) -> None:
    history.do(AddSingularities((singularity(1),)))
    history.undo()
    history.do(AddSingularities((singularity(2),)))
    assert history.redo_name is None
    history.redo()
    assert history.document.singularities == (singularity(2),)


def test_opening_is_a_border_that_undo_does_not_cross(history: History) -> None:
    history.do(AddSingularities((singularity(1),)))
    history.undo()
    other = Document.from_case("square", Case.from_json({"surface": {"builtin": "square"}}))
    history.open(other)
    assert history.undo_name is None
    assert history.redo_name is None
    history.undo()  # nothing is left: no harm
    history.redo()
    assert history.document is other


def test_commands_need_a_document() -> None:
    with pytest.raises(ValueError, match="no document"):
        History().do(AddSingularities((singularity(1),)))


@pytest.mark.parametrize(
    ("valence", "step", "expected"),
    [(3, 1, 5), (5, -1, 3), (5, 1, 6), (1, -1, 1), (12, 1, 12), (2, 1, 3)],
)
def test_wheel_skips_the_regular_valence_and_stops_at_the_limits(
    valence: int, step: int, expected: int
) -> None:
    assert next_valence(valence, step) == expected
