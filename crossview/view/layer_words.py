"""Settings of layers from outside, such as ``crosses.size=2`` or ``H.value_range=-1:1``."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from crossview.cases.json_values import JsonField
from crossview.cases.records import checked
from crossview.view.scene_view import LAYERS, LayerSettings
from solvers.errors import CrossviewError

TRUTHS = {"yes": True, "true": True, "no": False, "false": False}
"""Words for whether something is so."""

Settings = Mapping[str, Mapping[str, Any]]
"""Of layers, by layer and setting."""


def read_settings(words: Iterable[str]) -> Settings:
    """Return the settings of layers that words name.

    Parameters
    ----------
    words : iterable of str
        Each ``layer.setting=value``.

    Raises
    ------
    CrossviewError
        There is no such layer, or it has no such setting, or the value is none of it.

    Examples
    --------
    >>> from crossview.view.layer_words import read_settings
    >>> read_settings(["crosses.size=2", "H.value_range=-1:1"])
    {'crosses': {'size': 2.0}, 'H': {'value_range': (-1.0, 1.0)}}
    """
    given: dict[str, dict[str, Any]] = {}
    for word in words:
        place, equals, value = word.partition("=")
        layer, dot, setting = place.strip().partition(".")
        if not (equals and dot):
            raise CrossviewError(f'no setting "{word}"', "--set", "write it as crosses.size=2")
        given.setdefault(layer, {})[setting] = _value(value.strip())
    return checked_settings(given, "--set ")


def checked_settings(given: Settings, where: str) -> Settings:
    """Return settings of layers if they are such, as `LayerSettings` takes them.

    Parameters
    ----------
    given : mapping of str to mapping
        By layer and setting.
    where : str
        What stands before the place of a mistake.

    Raises
    ------
    CrossviewError
        There is no such layer, or it has no such setting, or the value is none of it.
    """
    kinds = {kind.name: kind for kind in LAYERS}
    found: dict[str, dict[str, Any]] = {}
    for layer, settings in given.items():
        if layer not in kinds:
            raise CrossviewError(f'no layer "{layer}"', "", "choose from " + ", ".join(kinds))
        for setting, value in settings.items():
            known, place = kinds[layer].settings, f"{where}{layer}.{setting}"
            if setting not in known:
                advice = "it has " + ", ".join(known) if known else "it has none"
                raise CrossviewError(f"the layer {layer} has no such setting", place, advice)
            given_value = list(value) if isinstance(value, tuple) else value
            taken = checked(LayerSettings, setting, JsonField(given_value, place))
            if setting == "value_range" and taken is not None and not taken[0] < taken[1]:
                raise CrossviewError("a range begins with its lower end", place)
            found.setdefault(layer, {})[setting] = taken
    return found


def _value(word: str) -> Any:
    """What a word means, as JSON has it."""
    if word.lower() in TRUTHS:
        return TRUTHS[word.lower()]
    try:
        numbers = [float(part) for part in word.split(":")]
    except ValueError:
        return word
    return numbers if len(numbers) > 1 else numbers[0]
