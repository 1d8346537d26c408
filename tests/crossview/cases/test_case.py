"""Case files: what they say comes back, and what is wrong in them is named with its place."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from crossview.cases.model import (
    Builtin,
    Case,
    CaseError,
    Options,
    PlacedCorner,
    PlacedFeatures,
    PlacedSingularity,
)
from solvers.errors import CrossviewError

FULL = {
    "title": "An annulus",
    "surface": {"builtin": "annulus", "inner": 0.4},
    "singularities": [
        {"position": [0.7, 0, 0], "valence": 3},
        {"position": [-0.7, 0, 0], "valence": 5, "locked": True},
    ],
    "connections": [[0, 1], [1, 1]],
    "corners": [{"position": [1, 0, 0], "index": 1}],
    "method": "isotropic",
    "options": {
        "tolerance_degrees": 0.5,
        "refine": 0,
        "component": 1,
        "repair": True,
        "turns": [0, -1],
        "proximal_weight": 0.001,
        "sizes": [[1, 2], [1.5, 0.5]],
    },
}


def test_reads_every_key() -> None:
    case = Case.from_json(FULL)
    assert case == Case(
        Builtin("annulus", {"inner": 0.4}),
        (
            PlacedSingularity((0.7, 0.0, 0.0), 3),
            PlacedSingularity((-0.7, 0.0, 0.0), 5, locked=True),
        ),
        (PlacedCorner((1.0, 0.0, 0.0), 1),),
        "isotropic",
        Options(0.5, 0, 1, True, (0, -1), 0.001, sizes=((1.0, 2.0), (1.5, 0.5))),
        title="An annulus",
        connections=((0, 1), (1, 1)),
    )


@pytest.mark.parametrize("data", [FULL, {"surface": "torus"}, {"surface": "torus", "corners": []}])
def test_saved_and_loaded_is_the_same(tmp_path: Path, data: dict[str, Any]) -> None:
    case = Case.from_json(data)
    case.save(tmp_path / "case.json")
    assert Case.load(tmp_path / "case.json") == case
    assert [p.name for p in tmp_path.iterdir()] == ["case.json"]


def test_a_surface_file_is_relative_to_its_case(tmp_path: Path) -> None:
    (tmp_path / "cases").mkdir()
    path = tmp_path / "cases" / "a.json"
    path.write_text('{"surface": "../meshes/a.obj", "options": {"sizes": "a.npy"}}')
    case = Case.load(path)
    assert case.surface == str(tmp_path / "meshes" / "a.obj")
    assert case.options.sizes == str(tmp_path / "cases" / "a.npy")
    # the file moves, what it names does not
    case.save(tmp_path / "b.json")
    saved = json.loads((tmp_path / "b.json").read_text())
    assert saved["surface"] == "meshes/a.obj"
    assert saved["options"]["sizes"] == "cases/a.npy"
    assert Case.load(tmp_path / "b.json") == case


def test_a_file_called_like_a_builtin_is_the_file(tmp_path: Path) -> None:
    assert Case.from_json({"surface": "torus"}, tmp_path).surface == Builtin("torus")
    (tmp_path / "torus").write_text("")
    assert Case.from_json({"surface": "torus"}, tmp_path).surface == str(tmp_path / "torus")


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"singularites": []}, 'unknown key "singularites".*did you mean "singularities"'),
        (
            {"options": {"tolerance": 1}},
            '"tolerance".*options.*mean "tolerance_degrees"',
        ),
        ({"surface": {"builtin": "anulus"}}, 'surface.builtin.*did you mean "annulus"'),
        ({"surface": {"builtin": "annulus", "iner": 1}}, 'surface.iner.*did you mean "inner"'),
        ({"surface": {"inner": 1}}, '"builtin" is missing.*surface'),
        ({"surface": ""}, "expected a text.*surface"),
        ({"surface": 3}, "expected a text, found 3"),
        ({"singularities": {}}, r"expected a list.*singularities"),
        ({"singularities": [{"valence": 3}]}, r'"position" is missing.*singularities\[0\]'),
        ({"singularities": [{"position": [0, 0], "valence": 3}]}, r"list of 3 .*\[0\]\.position"),
        ({"singularities": [{"position": [0, 0, float("nan")], "valence": 3}]}, r"NaN.*ion\[2\]"),
        ({"singularities": [{"position": [0, 0, 10**400], "valence": 3}]}, r"finite.*ion\[2\]"),
        ({"singularities": [{"position": [0, 0, 1e300], "valence": 3}]}, r"below 1e.*ion\[2\]"),
        ({"singularities": [{"position": [0, 0, "1"], "valence": 3}]}, r"number.*position\[2\]"),
        ({"singularities": [{"position": [0, 0, 0], "valence": 0}]}, r"from 1 to 100, found 0"),
        (
            {"singularities": [{"position": [0, 0, 0], "valence": 10**18}]},
            r"from 1 to 100, found 1",
        ),
        ({"corners": [{"position": [0, 0, 0], "index": -(10**18)}]}, r"from -98 to 1, found -1"),
        ({"singularities": [{"position": [0, 0, 0], "valence": 3.5}]}, r"whole number.*3\.5"),
        (
            {"singularities": [{"position": [0, 0, 0], "valence": True}]},
            "whole number from 1 to 100, found true",
        ),
        ({"singularities": [{"position": [0] * 3, "valence": 3, "locked": 1}]}, "true or false"),
        ({"connections": [[0, 1]]}, r"no singularities to be connected.*connections"),
        ({"connections": [0, 1]}, r"expected a list of 2 whole numbers.*connections\[0\]"),
        ({"corners": "automatic"}, 'expected "auto" or a list .*found "automatic"'),
        ({"corners": [{"position": [0, 0, 0], "index": 2}]}, r"to 1, found 2.*corners\[0\]\.index"),
        ({"method": "anistropic"}, 'unknown method "anistropic".*method.*mean "anisotropic"'),
        ({"options": {"turns": 1}}, r"expected a list.*options\.turns"),
        ({"options": {"turns": [0, 0.5]}}, r"whole number, found 0\.5.*turns\[1\]"),
        ({"options": {"proximal_weight": 0}}, "above 0, found 0.*proximal_weight"),
        ({"options": {"sizes": "sizes.csv"}}, r"a \.npy or \.txt file.*options\.sizes"),
        ({"options": {"sizes": [1, -1]}}, r"above 0.*sizes\[1\]"),
        ({"options": {"sizes": [[1, 2], 3]}}, r"list of 2 numbers above 0, found 3.*sizes\[1\]"),
        ({"options": {"sizes": [1, float("inf")]}}, r"finite.*sizes\[1\]"),
        ({"options": {"refine": -1}}, "from 0 to 10, found -1.*options.refine"),
        (
            {"options": {"tolerance_degrees": 0}},
            "above 0 and at most 45, found 0.*options.tolerance_degrees",
        ),
        (
            {"options": {"component": "biggest"}},
            '"largest", "all" or a whole .*"biggest"',
        ),
        ({"options": []}, r"expected an object \{...\}, found \[\]"),
    ],
)
def test_what_is_wrong_is_named_with_its_place(change: dict[str, Any], said: str) -> None:
    with pytest.raises(CaseError, match=said) as caught:
        Case.from_json({"surface": "torus", **change})
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ('{"surface": "torus",\n "options": {]}', "malformed JSON.*line 2, column 14"),
        ("", "malformed JSON.*line 1, column 1"),
        ("[" * 100000, "nested too deeply"),
        ('{"surface": %s}' % ("9" * 5000), "a number is too long"),
        ('{"surface": "torus", "surface": "disk"}', '"surface" stands twice'),
        ("[1]", "expected an object"),
    ],
)
def test_a_broken_file_is_refused(tmp_path: Path, text: str, said: str) -> None:
    path = tmp_path / "case.json"
    path.write_text(text)
    with pytest.raises(CaseError, match=said) as caught:
        Case.load(path)
    assert "case.json" in str(caught.value)


def test_a_byte_order_mark_is_no_mistake(tmp_path: Path) -> None:
    (tmp_path / "case.json").write_text('{"surface": "torus"}', encoding="utf-8-sig")
    assert Case.load(tmp_path / "case.json").surface == Builtin("torus")


def test_a_missing_or_binary_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(CaseError, match=r"No such file.*none\.json"):
        Case.load(tmp_path / "none.json")
    with pytest.raises(CaseError, match="Is a directory"):
        Case.load(tmp_path)
    (tmp_path / "picture.json").write_bytes(b"\x89PNG\xff\xfe")
    with pytest.raises(CaseError, match="not a text file"):
        Case.load(tmp_path / "picture.json")


def test_saving_where_nothing_can_be_written_says_so(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(CrossviewError, match=r"cannot write, Not a directory.*file"):
        Case(Builtin("torus")).save(tmp_path / "file" / "case.json")
    assert [p.name for p in tmp_path.iterdir()] == ["file"]


ORIGIN = {"position": (0.0, 0.0, 0.0)}


@pytest.mark.parametrize(
    ("kind", "values", "said"),
    [
        (PlacedSingularity, ORIGIN | {"valence": 3.5}, r"whole number from 1.*3\.5 \(valence\)"),
        (PlacedSingularity, ORIGIN | {"valence": True}, r"whole number.*true \(valence\)"),
        (PlacedCorner, ORIGIN | {"index": 0.5}, r"whole number.*0\.5 \(index\)"),
        (PlacedFeatures, {"dihedral_degrees": np.nan}, r"finite.*\(dihedral_degrees\)"),
        (Options, {"tolerance_degrees": np.nan}, r"finite number.*\(tolerance_degrees\)"),
        (Options, {"refine": np.float64(2.5)}, r"whole number.*2\.5 \(refine\)"),
        (Options, {"proximal_weight": -1.0}, r"number above 0.*-1\.0 \(proximal_weight\)"),
        (Options, {"turns": (0, 0.5)}, r"turns must be whole numbers, not 0\.5 \(row 1\)"),
        (Options, {"sizes": ("small",)}, "the size map must be numbers"),
    ],
)
def test_numbers_of_cases_made_in_python_are_checked(
    kind: Callable[..., object], values: dict[str, Any], said: str
) -> None:
    with pytest.raises(CaseError, match=said):
        kind(**values)


def test_numbers_of_numpy_and_whole_floats_are_what_they_say() -> None:
    arrays: dict[str, Any] = {"turns": np.array([1, 2]), "sizes": np.ones((2, 2))}
    lists: dict[str, Any] = {"turns": [1.0, 2], "sizes": [[1, 1], [1, 1]]}
    made = Options(refine=np.int64(2), **arrays)  # type: ignore[arg-type]
    assert made == Options(refine=2, **lists)
    assert (made.turns, made.sizes) == ((1, 2), ((1.0, 1.0), (1.0, 1.0)))
    assert type(made.refine) is int


def test_a_key_of_older_files_is_read_over() -> None:
    """`verify` was one: what it measured says less than topology does."""
    options = {"refine": 1, "verify": True}
    case = Case.from_json({"surface": "torus", "options": options})
    assert case == Case.from_json({"surface": "torus", "options": {"refine": 1}})
    assert "verify" not in case.to_json().get("options", {})
    with pytest.raises(CaseError, match='unknown key "verify"'):
        Case.from_json({"surface": "torus", "verify": True})
