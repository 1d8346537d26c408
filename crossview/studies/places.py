"""Places in a case, such as singularities[0].position: values put there."""

from __future__ import annotations

import re
from dataclasses import fields, replace
from typing import Any

from crossview.cases.json_values import CaseError, JsonField, nearest
from crossview.cases.records import checked
from crossview.studies.steps import STEPS, Step


def put(data: dict[str, Any], place: str, value: Any) -> None:
    """Put a value into a case as JSON has it; objects on the way are made if they are missing.

    Parameters
    ----------
    data : dict
        The case; it is changed.
    place : str
        Names of keys with points between them, and positions in lists.
    value : object
        As JSON has it.

    Raises
    ------
    CaseError
        There is nothing of that place.
    """
    way = [int(part) if part.isdecimal() else part for part in re.findall(r"[^.\[\]]+", place)]
    holder: Any = data
    for here, following in zip(way, [*way[1:], None], strict=True):
        if isinstance(here, int):
            fits = isinstance(holder, list) and here < len(holder)
        else:
            fits = isinstance(holder, dict)
        if not fits:
            raise CaseError(f'the case has no place "{place}"', "vary", "add what it is part of")
        if following is None:
            holder[here] = value
        elif isinstance(here, str) and isinstance(following, str):
            holder = holder.setdefault(here, {})
        elif isinstance(here, str) and here not in holder:
            raise CaseError(f'the case has no place "{place}"', "vary", "add what it is part of")
        else:
            holder = holder[here]


def of_a_step(place: str) -> bool:
    """Whether a place is in the options of a step.

    Parameters
    ----------
    place : str
        Such as quads.edge_length.
    """
    return place.partition(".")[0] in STEPS


def with_option(steps: tuple[Step, ...], place: str, value: Any) -> tuple[Step, ...]:
    """Return steps one of which has another option.

    Parameters
    ----------
    steps : tuple of Step
        Those of a study.
    place : str
        The step's name, a point and the option's.
    value : object
        As JSON has it.

    Raises
    ------
    CaseError
        There is no such step or option, or the value is wrong.
    """
    name, _, option = place.partition(".")
    taken = {step.name: step for step in steps}
    if name not in taken:
        raise CaseError(f'the study has no step "{name}"', "vary", "add it to the steps")
    known = [field.name for field in fields(STEPS[name])]
    if option not in known:
        raise CaseError(
            f'the step "{name}" has no option "{option}"', "vary", nearest(option, known)
        )
    given = checked(STEPS[name], option, JsonField(value, "vary", place))
    changed = Step(name, replace(taken[name].options, **{option: given}))
    return tuple(changed if step.name == name else step for step in steps)
