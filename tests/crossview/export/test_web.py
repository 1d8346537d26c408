"""A figure as a page: what is in it, that it needs nothing else, and that a browser turns it."""

from __future__ import annotations

import base64
import json
import re
import shutil
import subprocess
from functools import cache
from html import unescape
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

import crossview
from crossview.cases.pictured import Pictured
from crossview.cli import main
from crossview.export.figures import render
from solvers.errors import CrossviewError

BROWSERS = ("chromium", "chromium-browser", "google-chrome", "chrome", "msedge")


@cache
def solved(name: str) -> tuple[crossview.Solution, crossview.QuadLayout, crossview.QuadMesh]:
    solution = crossview.solve(crossview.read(name))
    layout = crossview.layout(solution)
    return solution, layout, crossview.quads(layout, 300)


def page(path: Path, name: str, layers: tuple[str, ...]) -> tuple[str, dict[str, Any]]:
    """The text of a page, and the figure in it."""
    solution, layout, quads = solved(name)
    render(solution, path, layers=layers, layout=layout, quads=quads, size=(640, 480))
    text = path.read_text(encoding="utf-8")
    found = re.search(r'<script type="application/json" id="figure">(.*?)</script>', text)
    assert found is not None
    return text, json.loads(found[1])


def floats(text: str) -> np.ndarray:
    return np.frombuffer(base64.b64decode(text), "<f4").reshape(-1, 3)


def ints(text: str) -> np.ndarray:
    return np.frombuffer(base64.b64decode(text), "<u4").reshape(-1, 3)


LAYERS = ("H", "crosses", "separatrices", "cut", "boundary", "singularities", "legend", "axes")


def test_a_page_holds_the_surface_the_curves_and_the_singularities(tmp_path: Path) -> None:
    _, figure = page(tmp_path / "figure.html", "disk-4", LAYERS)
    surface = solved("disk-4")[0].surface
    given = figure["surface"]
    places, faces = floats(given["places"]), ints(given["triangles"])
    assert len(faces) == surface.n_faces
    # the unit is the diagonal of the box, its middle the origin
    across = np.linalg.norm(np.ptp(surface.vertices, axis=0))
    corners = places[faces]
    areas = 0.5 * np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )
    np.testing.assert_allclose(areas.sum() * across**2, surface.area, rtol=1e-5)
    np.testing.assert_allclose(np.ptp(places, axis=0).sum() / 2, 1 / np.sqrt(2), atol=1e-6)
    assert np.abs(np.linalg.norm(floats(given["normals"]), axis=1) - 1).max() < 1e-5
    (discs,) = figure["discs"]
    np.testing.assert_allclose(
        np.linalg.norm(floats(discs["centres"]), axis=1) * across, 0.55, rtol=1e-5
    )
    # crosses, separatrices with their rim, boundary, cut with its rim
    assert len(figure["lines"]) == 6
    heights = [each["towards"] for each in figure["lines"]]
    assert len(set(heights)) == len(heights)
    assert figure["legend"] == [[3, "#2f6fde"]]
    assert figure["bar"]["title"] == "H"


def test_a_page_needs_nothing_from_elsewhere(tmp_path: Path) -> None:
    text, _ = page(tmp_path / "figure.html", "disk-4", LAYERS)
    assert not re.search(r"""(?i)(src|href)\s*=|@import|url\(|\bimport\b|fetch\(|https?:""", text)


def test_quads_are_two_triangles_of_one_colour(tmp_path: Path) -> None:
    _, figure = page(tmp_path / "figure.html", "disk-4", ("quads", "singularities"))
    mesh = solved("disk-4")[2]
    given = figure["surface"]
    assert len(ints(given["triangles"])) == 2 * mesh.n_quads
    colors = np.frombuffer(base64.b64decode(given["colors"]), np.uint8).reshape(-1, 6, 3)
    assert (colors == colors[:, :1]).all()


def test_a_title_cannot_end_the_script(tmp_path: Path) -> None:
    from dataclasses import replace

    from crossview.export.web import web_page
    from crossview.scene import field_view

    title = "</script><b>&"
    view = replace(field_view(solved("disk-4")[0].field), title=title)
    text = web_page(view, (640, 480))
    assert text.count("</script>") == 2
    found = re.search(r'id="figure">(.*?)</script>', text)
    assert found is not None
    assert json.loads(found[1])["title"] == title
    named = re.search(r"<title>(.*?)</title>", text)
    assert named is not None
    assert unescape(named[1]) == title


def test_the_command_writes_a_page_that_opens_as_its_case(tmp_path: Path) -> None:
    path = tmp_path / "figure.html"
    options = ["--layers", "H,singularities", "--camera", "iso", "--quiet"]
    assert main(["render", "disk-4", "-o", str(path), *options]) == 0
    pictured = Pictured.load(path)
    assert (pictured.camera, len(pictured.case.singularities)) == ("iso", 4)


def test_a_solution_shows_itself_in_a_notebook() -> None:
    view = crossview.picture(solved("disk-4")[0], layers=("H", "singularities"), height=300)
    html = view._repr_html_()
    assert html.startswith("<iframe")
    assert 'height="300"' in html
    found = re.search(r'srcdoc="(.*?)"', html, re.DOTALL)
    assert found is not None
    assert "<canvas" in unescape(found[1])
    with pytest.raises(CrossviewError, match="no layer"):
        crossview.picture(solved("disk-4")[0], layers=("heights",))


@pytest.mark.skipif(shutil.which("node") is None, reason="no node to read the script")
def test_the_script_of_a_page_is_one(tmp_path: Path) -> None:
    text, _ = page(tmp_path / "figure.html", "disk-4", ("H",))
    script = re.findall(r"<script>(.*?)</script>", text, re.DOTALL)[-1]
    (tmp_path / "figure.js").write_text(script, encoding="utf-8")
    ran = subprocess.run(
        ["node", "--check", tmp_path / "figure.js"], capture_output=True, text=True, check=False
    )
    assert (ran.returncode, ran.stderr) == (0, "")


BROWSER = next(filter(None, map(shutil.which, BROWSERS)), None)

TURNED = """<script>
const before = [...camera.back], far = camera.distance;
for (const key of ["ArrowLeft", "ArrowLeft", "ArrowUp"])
  canvas.dispatchEvent(new KeyboardEvent("keydown", { key }));
canvas.dispatchEvent(new WheelEvent("wheel", { deltaY: -100 }));
const away = [dot(before, camera.back), camera.distance / far];
for (const key of ["r"]) canvas.dispatchEvent(new KeyboardEvent("keydown", { key }));
draw();  // however seldom a browser without a screen asks for it
document.title = JSON.stringify([...away, dot(before, camera.back)]);
</script>"""
"""Turns the figure by 0.2 and 0.1 radians, comes nearer, and takes the first view again."""


def browse(path: Path, *options: str) -> str:
    assert BROWSER is not None
    command = [
        BROWSER, "--headless=new", "--no-sandbox", "--use-angle=swiftshader",
        "--enable-unsafe-swiftshader", "--hide-scrollbars", "--virtual-time-budget=3000",
        "--window-size=640,480", f"--user-data-dir={path.parent / 'browser'}", *options,
        path.as_uri(),
    ]  # fmt: skip
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout


@pytest.mark.skipif(BROWSER is None, reason="no browser to turn a page in")
def test_a_browser_shows_and_turns_a_page(tmp_path: Path) -> None:
    layers = ("H", "singularities", "axes")
    path = tmp_path / "figure.html"
    text, _ = page(path, "sphere-cube", layers)
    browse(path, f"--screenshot={tmp_path / 'seen.png'}")
    solution = solved("sphere-cube")[0]
    render(solution, tmp_path / "drawn.png", layers=layers, size=(640, 480))
    seen, drawn = (
        np.asarray(Image.open(tmp_path / f"{name}.png").convert("RGB").resize((64, 48)), float)
        for name in ("seen", "drawn")
    )
    assert np.abs(seen - drawn).mean() < 8  # of 255: the same sphere in the same light
    turned = tmp_path / "turned.html"
    turned.write_text(text.replace("</body>", TURNED + "</body>"), encoding="utf-8")
    dom = browse(turned, "--dump-dom")
    told = re.search(r"<title>(.*?)</title>", dom)
    assert told is not None
    cosine, nearer, back = json.loads(told[1])
    np.testing.assert_allclose(cosine, np.cos(0.2) * np.cos(0.1), atol=1e-6)
    assert nearer < 1
    np.testing.assert_allclose(back, 1)
    assert int(re.findall(r'data-drawn="(\d+)"', dom)[0]) >= 1
