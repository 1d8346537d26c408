"""What is missing is named before VTK could crash on it."""

import os
import subprocess
import sys

import pytest

from crossview.scene.display import RenderingError, ensure_rendering, require, software_renderer


def test_missing_libraries_are_named_with_their_cure() -> None:
    packages = {"libc.so.6": "libc6", "libNotThere.so.9": "libnot1", "libNorThis.so": "libnor1"}
    with pytest.raises(RenderingError) as caught:
        require(packages)
    assert str(caught.value) == (
        "cannot draw, libNotThere.so.9 and libNorThis.so not found (system libraries): "
        "sudo apt-get install -y --no-install-recommends libnot1 libnor1"
    )


def test_this_machine_draws() -> None:
    ensure_rendering()
    assert isinstance(software_renderer(), bool)


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="EGL is Linux's")
def test_without_a_display_vtk_is_sent_to_egl() -> None:
    code = (
        "from crossview.scene import ensure_rendering; ensure_rendering()\n"
        "import pyvista; p = pyvista.Plotter(off_screen=True); p.screenshot(return_img=True)\n"
        "print(p.ren_win.GetClassName())"
    )
    environment = {k: v for k, v in os.environ.items() if k != "DISPLAY"}
    done = subprocess.run(
        [sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=False
    )
    assert done.stdout.strip() == "vtkEGLRenderWindow", done.stderr
    assert "X server" not in done.stderr
