"""How a project is looked at: layers, camera, colour ranges, and the quads that it shows."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from crossview.cases.compounds import ListOf
from crossview.cases.json_values import JsonField
from crossview.cases.project import Project
from crossview.cases.records import Record
from crossview.cases.scalars import Number, Text
from crossview.session.state import SessionState
from crossview.view.scalars import SCALARS
from crossview.view.scene_view import LAYERS, LayerSettings
from crossview.workflow.quads import MeshOptions
from solvers.errors import CrossviewError

RANGE = ListOf(Number(), length=2, name="pairs of numbers")
"""How limits of colours are written."""


@dataclass(frozen=True)
class Look:
    """What a project keeps besides its case.

    Parameters
    ----------
    camera : str
        As of ``crossview render --camera``.
    layers : mapping of str to LayerSettings
        Those that are not as at first.
    ranges : mapping of str to (float, float)
        Colour ranges that were fitted, which pictures of other methods keep to.
    quads : MeshOptions, optional
        What quads are shown: the same are made again from it.
    """

    camera: str = "auto"
    layers: Mapping[str, LayerSettings] = field(default_factory=dict)
    ranges: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    quads: MeshOptions | None = None

    @classmethod
    def of(
        cls, state: SessionState, camera: str, ranges: Mapping[str, tuple[float, float]]
    ) -> Look:
        """Return how a state is looked at."""
        changed = {
            kind.name: state.layers[kind.name]
            for kind in LAYERS
            if state.layers[kind.name] != kind.defaults(kind.visible)
        }
        made = state.made
        return cls(camera, changed, dict(ranges), None if made.quads is None else made.options)

    @classmethod
    def load(cls, path: str | Path) -> Look:
        """Read how the project in a file is looked at.

        Raises
        ------
        CrossviewError
            The file or what it says is wrong.
        """
        read = JsonField(dict(Project.load(path).look), str(path), "look")
        members = read.object((), ("camera", "layers", "ranges", "quads"))
        layers, ranges = (
            members[name].object((), known) if name in members else {}
            for name, known in (("layers", [kind.name for kind in LAYERS]), ("ranges", SCALARS))
        )
        quads = members.get("quads")
        return cls(
            Text().read(members["camera"], Path()) if "camera" in members else "auto",
            {name: _settings(entry) for name, entry in layers.items()},
            {name: _range(entry) for name, entry in ranges.items()},
            None if quads is None else _options(quads),
        )

    def to_json(self) -> dict[str, Any]:
        """Return it as JSON values."""
        told: dict[str, Any] = {"camera": self.camera}
        record = Record(LayerSettings)
        told["layers"] = {n: record.write(one, Path()) for n, one in self.layers.items()}
        told["ranges"] = {name: list(limits) for name, limits in self.ranges.items()}
        if self.quads is not None:
            told["quads"] = dataclasses.asdict(self.quads)
        return told


def _settings(entry: JsonField) -> LayerSettings:
    settings: LayerSettings = Record(LayerSettings).read(entry, Path())
    if settings.value_range is not None and "value_range" in entry.value:
        _range(entry.members()["value_range"])
    return settings


def _range(entry: JsonField) -> tuple[float, float]:
    low, high = RANGE.read(entry, Path())
    if not low < high:
        raise entry.error("the first of two limits must be the smaller one")
    return low, high


def _options(entry: JsonField) -> MeshOptions:
    known = [part.name for part in dataclasses.fields(MeshOptions)]
    members = entry.object((), known)
    try:
        return MeshOptions(**{name: member.value for name, member in members.items()})
    except CrossviewError as error:
        raise entry.error(error.what, error.advice) from error
