"""Paths that no file can have are told in one line, and leave nothing behind."""

from pathlib import Path

import pytest

from crossview.cases.gallery import find_case
from crossview.cases.model import Builtin, Case
from solvers.errors import CrossviewError

LONG = "a" * 5000


@pytest.mark.parametrize("target", [LONG, f"{LONG}.obj", f"{LONG}.json"])
def test_a_name_too_long_is_no_file(target: str) -> None:
    with pytest.raises(CrossviewError) as refused:
        find_case(target)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize("name", [".", LONG, "folder", f"{LONG}.json", "folder.json"])
def test_a_case_is_not_written_where_no_file_can_be(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("folder").mkdir()
    Path("folder.json").mkdir()
    with pytest.raises(CrossviewError, match="cannot write"):
        Case(Builtin("disk")).save(name)
    assert sorted(path.name for path in tmp_path.rglob("*")) == ["folder", "folder.json"]
