"""Any sequence of commands, undone and redone in any order: the documents are those there were."""

from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import (
    RuleBasedStateMachine,
    initialize,
    invariant,
    precondition,
    rule,
    run_state_machine_as_test,
)

from crossview.cases.model import METHODS, Builtin, Case
from crossview.session.commands import (
    AddSingularities,
    ChangeValence,
    ChooseMethod,
    Command,
    LockSingularity,
    MarkFeatures,
    MoveSingularity,
    RemoveSingularities,
    ReplaceSingularities,
)
from crossview.session.document import Document
from crossview.session.history import History
from crossview.workflow.marking import Marking
from solvers.singularities import Singularity
from solvers.surface import SurfacePoint

OPENED = [
    Document.from_case(name, Case(Builtin(name, {"n": 12}))) for name in ("square", "annulus")
]
POINTS = st.builds(
    SurfacePoint,
    st.integers(0, min(document.surface.n_faces for document in OPENED) - 1),
    st.just((0.25, 0.25, 0.5)),
)
SINGULARITIES = st.builds(Singularity, POINTS, st.integers(1, 12), locked=st.booleans())
SEVERAL = st.lists(SINGULARITIES, min_size=1, max_size=3).map(tuple)


class Editing(RuleBasedStateMachine):
    """A history beside the plain list of the documents it went through and what led to each."""

    def __init__(self) -> None:
        super().__init__()
        self.history = History()
        self.documents: list[Document | None] = []
        self.names: list[str] = []
        self.at = 0

    def went(self, name: str) -> None:
        """Whatever was undone is forgotten; what is there now is the end."""
        del self.documents[self.at + 1 :], self.names[self.at :]
        self.documents.append(self.history.document)
        self.names.append(name)
        self.at += 1

    def do(self, command: Command) -> Document:
        before = self.history.document
        assert before is not None
        self.history.do(command)
        self.went(command.name)
        after = self.history.document
        assert after is not None
        assert after.surface is before.surface
        return after

    @property
    def singularities(self) -> tuple[Singularity, ...]:
        document = self.history.document
        return document.singularities if document is not None else ()

    @initialize()
    def start(self) -> None:
        self.opens(OPENED[0])

    @rule(document=st.sampled_from(OPENED))
    def opens(self, document: Document) -> None:
        """Undo and redo do not reach beyond it."""
        self.history.open(document)
        self.documents, self.names, self.at = [document], [], 0

    @rule(added=SEVERAL)
    @precondition(lambda self: self.history.document is not None)
    def adds(self, added: tuple[Singularity, ...]) -> None:
        before = self.singularities
        assert self.do(AddSingularities(added)).singularities == before + added

    @rule(placed=SEVERAL, automatic=st.booleans())
    @precondition(lambda self: self.history.document is not None)
    def replaces(self, placed: tuple[Singularity, ...], automatic: bool) -> None:
        command = ReplaceSingularities(placed, "make valid", automatic_corners=automatic)
        assert self.do(command).singularities == placed

    @rule(data=st.data(), point=POINTS, valence=st.integers(1, 12), locked=st.booleans())
    @precondition(lambda self: self.singularities)
    def changes_one(
        self, data: st.DataObject, point: SurfacePoint, valence: int, locked: bool
    ) -> None:
        before = self.singularities
        index = data.draw(st.integers(0, len(before) - 1))
        changes: list[Command] = [
            MoveSingularity(index, point),
            ChangeValence(index, valence),
            LockSingularity(index, locked),
        ]
        after = self.do(data.draw(st.sampled_from(changes))).singularities
        assert after[:index] + after[index + 1 :] == before[:index] + before[index + 1 :]

    @rule(data=st.data())
    @precondition(lambda self: self.singularities)
    def removes(self, data: st.DataObject) -> None:
        numbers = st.integers(0, len(self.singularities) - 1)
        removed = data.draw(st.frozensets(numbers, min_size=1))
        kept = tuple(s for i, s in enumerate(self.singularities) if i not in removed)
        assert self.do(RemoveSingularities(removed)).singularities == kept

    @rule(method=st.sampled_from(METHODS))
    @precondition(lambda self: self.history.document is not None)
    def chooses(self, method: str) -> None:
        assert self.do(ChooseMethod(method)).problem.method == method

    @rule(degrees=st.floats(1.0, 180.0))
    @precondition(lambda self: self.history.document is not None)
    def marks(self, degrees: float) -> None:
        assert self.do(MarkFeatures(Marking(degrees))).problem.marking == Marking(degrees)

    @rule(steps=st.integers(1, 3))
    def undoes(self, steps: int) -> None:
        for _ in range(steps):
            self.history.undo()
        self.at = max(self.at - steps, 0)

    @rule(steps=st.integers(1, 3))
    def redoes(self, steps: int) -> None:
        for _ in range(steps):
            self.history.redo()
        self.at = min(self.at + steps, len(self.names))

    @invariant()
    def is_where_the_list_says(self) -> None:
        assert self.history.document is self.documents[self.at]
        assert self.history.undo_name == (self.names[self.at - 1] if self.at else None)
        later = self.names[self.at :]
        assert self.history.redo_name == (later[0] if later else None)

    def teardown(self) -> None:
        """All undone is the start, all redone the end, one by one."""
        for _ in range(self.at):
            self.undoes(1)
            self.is_where_the_list_says()
        assert self.history.document is self.documents[0]
        for _ in self.names:
            self.redoes(1)
            self.is_where_the_list_says()
        assert self.history.document is self.documents[-1]


def test_any_sequence_of_commands_comes_back_and_again() -> None:
    run_state_machine_as_test(Editing, settings=settings(max_examples=40, stateful_step_count=30))
