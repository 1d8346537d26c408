"""The surface of a case: made or read, and repaired."""

from __future__ import annotations

from dataclasses import dataclass

from crossview.cases.model import Builtin, Case
from crossview.io import RawSurface, read_surface
from solvers.errors import SurfaceError
from solvers.primitives import BUILTIN
from solvers.remedies import Remedy, RepairSurface, TakeLargest
from solvers.repair import Repaired, repair, repair_each


@dataclass(frozen=True)
class RepairAndChoose(Remedy):
    """Repair a surface that then is in pieces, and take the largest."""

    @property
    def label(self) -> str:
        """What a button says that does it."""
        return "Repair, use the largest piece"


def load_surfaces(case: Case) -> tuple[Repaired, ...]:
    """The surface of a case, or every component of it if the case asks for all.

    Each comes with notes on what was changed to make it a surface.

    Raises
    ------
    CrossviewError
        It cannot be read or is none, or has several components and the case chooses none.
    """
    if isinstance(case.surface, Builtin):
        name, parameters = case.surface.name, case.surface.parameters
        if case.options.component not in (None, "all", "largest", 0):
            raise SurfaceError(
                f"there is no component {case.options.component}",
                f"built-in {name}",
                "a built-in surface has only one",
            )
        try:
            return (Repaired(BUILTIN[name](**parameters)),)
        except SurfaceError as error:
            error.locate(f"built-in {name}")
            raise
    return mended(read_surface(case.surface), case)


def mended(raw: RawSurface, case: Case) -> tuple[Repaired, ...]:
    """What was read for a case, as the surface or surfaces it asks for."""
    chosen, cut_apart = case.options.component, case.options.repair
    try:
        if chosen == "all":
            pieces = repair_each(raw.vertices, raw.faces, merge=raw.merge, cut_apart=cut_apart)
        else:
            pieces = (
                repair(
                    raw.vertices,
                    raw.faces,
                    merge=raw.merge,
                    cut_apart=cut_apart,
                    component=chosen,
                ),
            )
    except SurfaceError as error:
        error.locate(str(case.surface))
        if chosen is None and not cut_apart:
            error.remedies = _lasting(error.remedies, raw)
        raise
    return tuple(Repaired(piece.surface, (*raw.notes, *piece.notes)) for piece in pieces)


def _lasting(remedies: tuple[Remedy, ...], raw: RawSurface) -> tuple[Remedy, ...]:
    """Return remedies after which nothing else is wrong: a repair may leave several pieces."""
    if not any(isinstance(remedy, RepairSurface) for remedy in remedies):
        return remedies
    try:
        repair(raw.vertices, raw.faces, merge=raw.merge, cut_apart=True)
    except SurfaceError as left:
        if any(isinstance(remedy, TakeLargest) for remedy in left.remedies):
            return tuple(
                RepairAndChoose(f"{remedy.words}, and choose the largest piece")
                if isinstance(remedy, RepairSurface)
                else remedy
                for remedy in remedies
            )
    return remedies
