"""The program among the applications of a desktop."""

import os
import shutil
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import pytest

pytestmark = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="desktops of Linux")


@pytest.fixture(scope="module")
def data(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A temporary XDG_DATA_HOME that the program is installed into."""
    folder = tmp_path_factory.mktemp("a home") / "share"
    ran = subprocess.run(
        [sys.executable, "-P", "-m", "crossview", "--install-desktop"],
        env={**os.environ, "XDG_DATA_HOME": str(folder)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert (ran.returncode, ran.stderr) == (0, "")
    assert all(Path(line.removeprefix("wrote ")).is_file() for line in ran.stdout.splitlines())
    return folder


def test_the_entry_is_right_and_starts_this_program(data: Path, tmp_path: Path) -> None:
    entry = data / "applications" / "crossview.desktop"
    if validate := shutil.which("desktop-file-validate"):
        ran = subprocess.run([validate, entry], capture_output=True, text=True, check=False)
        assert (ran.returncode, ran.stdout) == (0, "")
    lines = dict(line.split("=", 1) for line in entry.read_text().splitlines() if "=" in line)
    command = lines["Exec"].replace("%f", "--version")
    started = subprocess.run(
        command, shell=True, cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert (started.returncode, started.stderr) == (0, "")
    assert (data / "icons" / "hicolor" / "scalable" / "apps" / f"{lines['Icon']}.svg").is_file()


def test_case_files_are_of_a_kind_that_it_opens(data: Path) -> None:
    kinds = ElementTree.parse(data / "mime" / "packages" / "crossview.xml").getroot()
    (kind,) = kinds
    entry = (data / "applications" / "crossview.desktop").read_text()
    assert kind.attrib["type"] in entry
    globs = [tag.attrib["pattern"] for tag in kind if tag.tag.endswith("glob")]
    assert globs == ["*.crossview.json"]
    if shutil.which("update-mime-database"):
        assert kind.attrib["type"] in (data / "mime" / "globs2").read_text()
