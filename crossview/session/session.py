"""One session: a document, its history, what is shown of it, and all that can be done."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

from crossview.session.document import Document
from crossview.session.loop import Loop
from crossview.session.mending import mend
from crossview.session.message import Faulty, NaturalBy, ShowWhere
from crossview.session.opening import Opening, open_target, read_triangles
from crossview.session.store import Store
from crossview.session.verbs.edits import Edits
from crossview.session.verbs.feature_marks import FeatureMarks
from crossview.session.verbs.guide_lines import GuideLines
from crossview.session.verbs.looks import Looks
from crossview.session.verbs.measuring import Measuring
from crossview.session.verbs.moves import Moves
from crossview.session.verbs.near_misses import NearMissFinder
from crossview.session.verbs.pairs import Pairs
from crossview.session.verbs.pointer import Pointer
from crossview.session.verbs.quad_making import QuadMaking
from crossview.session.verbs.solving import Solving
from crossview.session.verbs.trials import Trials
from crossview.view.values import Elements
from crossview.workflow.loading import RepairAndChoose
from crossview.workflow.quads import MeshOptions
from solvers.remedies import MakeValid, Remedy, RepairSurface, TakeLargest
from solvers.surface import FloatArray, IntArray


class Session(Store):
    """The window without a window: holds the state behind verbs, and computes nothing itself.

    Parameters
    ----------
    loop : Loop
        The thread that it lives on: all its verbs are called there.
    """

    def __init__(self, loop: Loop) -> None:
        super().__init__()
        self.opened: list[Callable[[Opening], object]] = []
        """Told when a document has been opened."""
        self.may_leave: Callable[[], bool] = lambda: True
        """Asked before a document gives way to another."""
        self.solving = Solving(self, loop)
        self.edits = Edits(self, self.solving)
        self.looks = Looks(self, self.solving)
        self.pointer = Pointer(self)
        self.trials = Trials(self, self.solving, self.edits.do)
        self.moves = Moves(self, self.solving, self.edits.do)
        self.pairs = Pairs(self, self.solving, self.edits.do)
        self.feature_marks = FeatureMarks(self, self.solving, self.edits.do)
        self.quad_making = QuadMaking(self, self.solving)
        self.guide_lines = GuideLines(self, loop)
        self.near_misses = NearMissFinder(self, loop)
        self.measuring = Measuring(self, loop)

    @property
    def busy(self) -> bool:
        """Whether an answer of the background is still awaited."""
        parts = (self.solving, self.guide_lines, self.near_misses, self.measuring)
        return any(part.busy for part in parts)

    def close(self) -> None:
        """End the background threads."""
        self.guide_lines.close()
        self.near_misses.close()
        self.measuring.close()
        self.solving.close()

    def open(self, opening: Opening) -> None:
        """Open a file, gallery case or built-in surface in the background."""
        if not self.may_leave():
            return

        def failed(error: Exception) -> None:
            self.fail(error, "open", opening)
            self.solving.resume()

        self.solving.run(partial(open_target, opening), partial(self._show, opening), failed)

    def carry_out(self, remedy: Remedy, tried: Opening | MeshOptions | None = None) -> None:
        """Do what a button of a message or of the validity panel says.

        Parameters
        ----------
        remedy : Remedy
        tried : Opening, MeshOptions or None
            What has failed: a file is opened again, quads are made afterwards.
        """
        match remedy:
            case RepairSurface() if isinstance(tried, Opening):
                self.open(replace(tried, repair=True))
            case RepairAndChoose() if isinstance(tried, Opening):
                self.open(replace(tried, repair=True, component="largest"))
            case TakeLargest() if isinstance(tried, Opening):
                self.open(replace(tried, component="largest"))
            case ShowWhere(elements=elements) if isinstance(tried, Opening):
                self._locate(tried.target, elements)
            case MakeValid():
                self.moves.make_valid()
            case NaturalBy(method=method):
                self.moves.place_natural(method)
            case _:
                self._mend(remedy)
        if isinstance(tried, MeshOptions):
            self.quad_making.wait_for(tried)

    def _show(self, opening: Opening, document: Document) -> None:
        self.update(self.state.unsaid("open", "save", "export"))
        self.edits.open(document, kept=opening.restores is None)
        for tell in tuple(self.opened):
            tell(opening)

    def _locate(self, target: str, elements: Elements) -> None:
        """Show what could not be opened, the offending elements pointed out."""
        message = self.state.message

        def show(triangles: tuple[FloatArray, IntArray]) -> None:
            if message is not None and message is self.state.message:
                left = tuple(r for r in message.remedies if not isinstance(r, ShowWhere))
                faulty = Faulty(*triangles, elements)
                said = replace(message, remedies=left, faulty=faulty)
                self.update(self.state.said(said))
            self.solving.resume()

        self.solving.run(
            partial(read_triangles, target), show, lambda failure: self.fail(failure, "open")
        )

    def _mend(self, remedy: Remedy) -> None:
        document = self.state.document
        if document is not None:
            job = partial(mend, document, remedy)
            self.solving.run(job, self.edits.do, lambda error: self.fail(error, "edit"))
