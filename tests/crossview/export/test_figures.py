"""Figures of a solved case: files, pixels, vectors, and refusals."""

import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from crossview.cases.model import Case
from crossview.cases.pictured import Pictured
from crossview.export.figures import render, render_view
from crossview.scene import Marker, field_view
from crossview.view.colors import CUT, valence_color
from crossview.workflow.pipeline import Solution, solve_case
from solvers.errors import CrossviewError
from solvers.progress import run
from tests.command_line import Crossview

SIZE = (400, 300)


@pytest.fixture(scope="module")
def solution() -> Solution:
    places = [
        ((0.5, 0.0, 0.0), 3),
        ((-0.5, 0.0, 0.0), 3),
        ((0.0, 0.5, 0.0), 3),
        ((0.0, -0.5, 0.0), 3),
    ]
    case = Case.from_json(
        {
            "surface": {"builtin": "disk", "edge_length": 0.1},
            "singularities": [{"position": list(p), "valence": n} for p, n in places],
        },
        Path(),
    )
    (solved,) = run(solve_case(case))
    return solved


def count(image: Image.Image, color: str, tolerance: int = 3) -> int:
    wanted = [int(color[i : i + 2], 16) for i in (1, 3, 5)]
    pixels = np.asarray(image.convert("RGB"), int)
    return int((np.abs(pixels - wanted) <= tolerance).all(axis=-1).sum())


def test_png_of_the_size_asked_with_the_colours_of_the_paper(
    solution: Solution, tmp_path: Path
) -> None:
    path = render(solution, tmp_path / "a.png", size=SIZE, scale=2)
    image = Image.open(path)
    assert image.size == (800, 600)
    assert count(image, valence_color(3)) > 400
    assert image.convert("RGB").getpixel((0, 0)) == (255, 255, 255)


def test_only_the_layers_asked_are_drawn(solution: Solution, tmp_path: Path) -> None:
    names = ["surface", "boundary", "cut"]
    image = Image.open(render(solution, tmp_path / "a.png", layers=names, size=SIZE))
    assert count(image, valence_color(3)) == 0
    assert count(image, CUT, 30) > 50
    grey = np.asarray(image.convert("RGB"), int)
    colourful = np.ptp(grey, axis=-1) > 60
    assert colourful.mean() < 0.03


def test_transparent_has_no_background_but_the_same_surface(
    solution: Solution, tmp_path: Path
) -> None:
    opaque = Image.open(render(solution, tmp_path / "a.png", size=SIZE)).convert("RGB")
    clear = Image.open(render(solution, tmp_path / "b.png", size=SIZE, transparent=True))
    assert clear.mode == "RGBA"
    assert clear.getchannel("A").getpixel((0, 0)) == 0
    middle = (150, 150)
    assert clear.getchannel("A").getpixel(middle) == 255
    assert clear.convert("RGB").getpixel(middle) == opaque.getpixel(middle)
    on_white = Image.new("RGBA", clear.size, "white")
    on_white.alpha_composite(clear)
    off = np.abs(np.asarray(on_white.convert("RGB"), int) - np.asarray(opaque, int))
    assert np.mean(off.max(axis=-1) > 24) < 0.01


def test_scale_keeps_the_layout(solution: Solution, tmp_path: Path) -> None:
    small = Image.open(render(solution, tmp_path / "a.png", size=SIZE)).convert("RGB")
    large = Image.open(render(solution, tmp_path / "b.png", size=SIZE, scale=3)).convert("RGB")
    off = np.abs(np.asarray(large.reduce(3), int) - np.asarray(small, int)).max(axis=-1)
    assert off.mean() < 6.0


def test_svg_has_true_lines_discs_and_words(solution: Solution, tmp_path: Path) -> None:
    names = ["surface", "H", "crosses", "singularities", "cut", "boundary", "legend", "axes"]
    text = render(solution, tmp_path / "a.svg", layers=names, size=SIZE).read_text()
    assert text.count("<image") == 1
    assert text.count("<path") > 800
    assert text.count(valence_color(3)) >= 5
    assert CUT in text
    words = re.findall(r"<text[^>]*>([^<]*)</text>", text)
    assert {"valence", "3", "H", "0"} <= set(words)
    assert (tmp_path / "a.svg").read_text() == render(
        solution, tmp_path / "b.svg", layers=names, size=SIZE
    ).read_text()


def test_pdf_is_one_page_of_the_layouts_size(solution: Solution, tmp_path: Path) -> None:
    data = render(solution, tmp_path / "a.pdf", size=SIZE).read_bytes()
    assert data.startswith(b"%PDF")
    assert b"/MediaBox [ 0 0 144 108 ]" in data


def test_what_the_surface_hides_is_no_vector_either(tmp_path: Path) -> None:
    case = Case.from_json({"surface": {"builtin": "torus", "n": 48}}, Path())
    (solved,) = run(solve_case(case))
    seen, hidden = Marker((0.0, 0.0, 0.4), 6), Marker((0.0, 1.0, -0.4), 8)
    view = replace(
        field_view(solved.field),
        singularities=(replace(seen, position=(1.0, 0.0, 0.4)), hidden),
    ).with_layer("legend", visible=False)
    text = render_view(view, tmp_path / "a.svg", size=SIZE, camera="xy").read_text()
    assert valence_color(6) in text
    assert valence_color(8) not in text


@pytest.mark.parametrize(
    ("name", "options", "words"),
    [
        ("a.jpeg", {}, r"unknown kind of figure.*\.png, \.svg, \.pdf"),
        ("a.png", {"layers": ["H", "sparkles"]}, r'no layer "sparkles".*crosses'),
        ("a.png", {"layers": ["guide"]}, "the guide shows where one singularity may be dragged"),
        ("a.png", {"camera": "sideways"}, r'no camera "sideways".*iso'),
        ("a.png", {"size": (4, 3)}, "cannot draw 4 x 3 pixels"),
        ("a.png", {"size": (4000, 3000), "scale": 10}, "cannot draw 40000 x 30000 pixels"),
    ],
)
def test_mistakes_are_told_in_one_line_and_nothing_is_written(
    solution: Solution, tmp_path: Path, name: str, options: dict[str, Any], words: str
) -> None:
    with pytest.raises(CrossviewError, match=words) as caught:
        render(solution, tmp_path / name, **options)
    assert "\n" not in str(caught.value)
    assert list(tmp_path.iterdir()) == []


def test_figures_side_by_side_have_one_camera_and_one_range(
    crossview: Crossview, tmp_path: Path
) -> None:
    options = ["--layers", "H,singularities", "--size", "240x180"]
    both = crossview("render", "disk-4", "teaser-c", "-o", tmp_path / "both.png", *options)
    assert (both.status, both.err) == (0, "")
    whole = np.asarray(Image.open(tmp_path / "both.png").convert("RGB"), float)
    assert whole.shape == (180, 480, 3)
    # the colour bars are the same, though the one alone has another range
    left, right = whole[60:170, 228:240], whole[60:170, 468:480]
    assert np.abs(left - right).max() < 2
    drawn = crossview("render", "disk-4", "teaser-c", "-o", tmp_path / "both.svg", *options)
    assert drawn.status == 0
    text = (tmp_path / "both.svg").read_text()
    assert text.count("<image") == 2
    assert Pictured.load(tmp_path / "both.svg").case.title == "Disk: four valence 3"
    page = crossview("render", "disk-4", "teaser-c", "-o", tmp_path / "both.html", *options)
    assert (page.status, page.err.count("\n")) == (2, 1)


def test_the_command_draws_layers_as_they_are_set(crossview: Crossview, tmp_path: Path) -> None:
    options = ["--layers", "H,boundary", "--size", "160x120", "--set", "H.opacity=0", "--dpi", 200]
    dark = ["--background", "dark"]
    ran = crossview("render", "disk-4", "-o", tmp_path / "a.png", *options, *dark)
    assert (ran.status, ran.err) == (0, "")
    with Image.open(tmp_path / "a.png") as image:
        assert round(image.info["dpi"][0]) == 200
        pixels = np.asarray(image.convert("RGB"))
    assert tuple(pixels[0, 0]) == (0x1D, 0x20, 0x26)
    assert np.ptp(pixels[60, 70].astype(int)) < 8  # grey, where H is not laid on


@pytest.mark.parametrize(
    ("word", "said"),
    [
        ("crosses", 'no setting "crosses"'),
        ("cross.size=2", 'no layer "cross"'),
        ("axes.size=2", "it has none"),
        ("H.color_map=jet", 'unknown "jet"'),
        ("H.value_range=1", "a list of 2 numbers"),
        ("H.value_range=2:1", "begins with its lower end"),
        ("crosses.size=big", "a number above 0"),
        ("surface.edges=maybe", "true or false"),
    ],
)
def test_a_setting_that_is_none_is_told(
    crossview: Crossview, tmp_path: Path, word: str, said: str
) -> None:
    ran = crossview("render", "disk-4", "-o", tmp_path / "a.png", "--set", word)
    assert (ran.status, ran.err.count("\n")) == (2, 1)
    assert said in ran.err
