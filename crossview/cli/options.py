"""What several commands take: their options, and the case they start from."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated, Any

from cyclopts import Parameter

from crossview.cases.gallery import find_case
from crossview.cases.model import Case, check_method
from crossview.workflow.quads import MeshOptions
from solvers.errors import CrossviewError

Output = Annotated[str, Parameter(name=["--output", "-o"])]
Flag = Annotated[bool, Parameter(negative="")]
Json = Annotated[bool, Parameter(name="--json", negative="")]


def chosen_case(
    target: str,
    method: str | None = None,
    component: str | None = None,
    repair: bool = False,
    features: float | None = None,
) -> Case:
    """The case that `target` names, with what the command line says instead.

    Raises
    ------
    CrossviewError
        There is no such case, or an option is wrong.
    """
    case = find_case(target)
    changes: dict[str, Any] = {"repair": True} if repair else {}
    if component is not None:
        changes["component"] = _component(component)
    case = replace(case, options=replace(case.options, **changes))
    if features is not None:
        if not 0 < features <= 180:
            raise CrossviewError(
                f"features cannot be sharper than {features:g} degrees",
                "--features",
                "an angle above 0 and at most 180",
            )
        case = replace(case, features=replace(case.features, dihedral_degrees=features))
    return case if method is None else replace(case, method=check_method(method, "--method"))


def mesh_options(
    quads: bool,
    edge_length: float | None,
    target_quads: int | None,
    collapse: bool,
    advice: str,
) -> MeshOptions | None:
    """What the command line says about quads; None if it wants none.

    Raises
    ------
    CrossviewError
        It wants none and says how they should be, or something impossible.
    """
    if quads:
        return MeshOptions(edge_length, target_quads, collapse)
    given = {"edge-length": edge_length, "target-quads": target_quads, "collapse": collapse or None}
    for name, value in given.items():
        if value is not None:
            raise CrossviewError(f"--{name} is about quads", "", advice)
    return None


def _component(text: str) -> int | str:
    if text in ("largest", "all"):
        return text
    if text.isdecimal():
        return int(text)
    raise CrossviewError(
        f'unknown component "{text}"', "--component", "largest, all or a number (0 is the largest)"
    )
