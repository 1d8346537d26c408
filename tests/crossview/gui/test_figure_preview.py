"""The Export panel shows the figure before it is written, and how large it is on paper."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from crossview.gui.figure import FigureSettings
from crossview.view.colors import THEMES, rgb, valence_color
from tests.windowing import Hand, count_color


def shown(hand: Hand) -> np.ndarray:
    """The preview's pixels, (height, width, 4); nothing while it is empty."""
    image = hand.window.export_panel.preview.pixmap().toImage()
    if image.isNull():
        return np.zeros((1, 1, 4), np.uint8)
    image = image.convertToFormat(image.Format.Format_RGBA8888)
    rows = np.frombuffer(image.constBits(), np.uint8)
    return rows.reshape(image.height(), -1, 4)[:, : image.width()].copy()


def test_it_shows_what_will_be_written(hand: Hand, tmp_path: Path) -> None:
    hand.open("disk-4")
    large = replace(hand.state.layers["singularities"], size=3.0)
    hand.window.session.looks.set_layer("singularities", large)
    hand.window.session.looks.toggle_layer("separatrices")  # they are as blue
    panel = hand.window.export_panel
    assert panel.preview.pixmap().isNull()  # nobody has looked yet
    hand.window.docks["Export"].raise_()
    hand.wait(lambda: shown(hand).shape[1] > 120)
    room = panel.preview.size()
    assert shown(hand).shape[:2] <= (room.height(), room.width())
    height, width, _ = shown(hand).shape
    assert width / height == pytest.approx(4 / 3, rel=0.03)
    blue = count_color(shown(hand), valence_color(3))
    assert blue > 20

    # hidden in the window, hidden in the figure
    hand.window.session.looks.toggle_layer("singularities")
    hand.wait(lambda: count_color(shown(hand), valence_color(3)) == 0)

    # turned, resized, on another ground
    before = shown(hand)
    hand.trigger("view-xz")
    hand.wait(lambda: shown(hand).shape != before.shape or (shown(hand) != before).any())
    panel.width_box.setValue(900)
    hand.wait(lambda: shown(hand).shape[1] < shown(hand).shape[0])
    hand.window.session.looks.toggle_dark()
    dark = np.round(255 * np.array(rgb(THEMES["dark"].background)))
    hand.wait(lambda: np.abs(shown(hand)[-30, 2, :3] - dark).max() <= 2)


def test_the_size_on_paper_is_said_and_written(hand: Hand, tmp_path: Path) -> None:
    panel = hand.window.export_panel
    panel.scale_box.setValue(2)
    panel.dpi_box.setValue(600)
    assert panel.result.text() == "3\u2009200 × 2\u2009400 pixels"
    assert (panel.across_box.value(), panel.up_box.value()) == (135.5, 101.6)
    panel.width_box.setValue(400)
    panel.height_box.setValue(300)
    assert panel.settings == FigureSettings((400, 300), 2, False, 600)
    hand.open("disk-4")
    for suffix in (".png", ".svg"):
        hand.window.files.export(tmp_path / f"disk{suffix}")
        hand.wait()
    with Image.open(tmp_path / "disk.png") as picture:
        assert picture.size == (800, 600)
        assert picture.info["dpi"] == pytest.approx((600, 600), rel=1e-3)
    # 800 pixels at 600 to the inch, 72 points each
    assert 'width="96pt" height="72pt"' in (tmp_path / "disk.svg").read_text()


def test_the_size_on_paper_can_be_typed(hand: Hand) -> None:
    panel = hand.window.export_panel
    panel.across_box.setValue(84.0)
    panel.up_box.setValue(63.0)
    panel.dpi_box.setValue(600)  # the paper stays as large
    assert panel.settings.size == (1984, 1488)
    assert panel.settings.millimetres == pytest.approx((84.0, 63.0), abs=0.05)
    panel.width_box.setValue(800)
    panel.height_box.setValue(600)
    panel.dpi_box.setValue(300)  # and now the pixels as many
    assert panel.settings.size == (800, 600)
    assert panel.across_box.value() == pytest.approx(67.7)


def test_what_is_transparent_is_seen_and_lettered_as_on_the_ground_shown(
    hand: Hand, tmp_path: Path
) -> None:
    hand.open("disk-4")
    hand.window.session.looks.toggle_dark()
    hand.window.docks["Export"].raise_()
    panel = hand.window.export_panel
    panel.transparent_box.setChecked(True)
    hand.wait(lambda: shown(hand).shape[1] > 120)
    middle = shown(hand).shape[0] // 2
    beside = shown(hand)[middle - 10 : middle + 10, 2:12, :3].reshape(-1, 3)  # the disk
    assert len(np.unique(beside, axis=0)) == 2
    hand.window.files.export(tmp_path / "dark.png")
    hand.wait()
    picture = np.asarray(Image.open(tmp_path / "dark.png"))
    assert picture[2, 2, 3] == 0
    light, dark = (
        ((picture[:60, ..., 3] == 255) & (np.abs(picture[:60, ..., :3] - wanted) < 20).all(axis=-1))
        for wanted in (255 * np.array(rgb(THEMES[name].text)) for name in ("dark", "white"))
    )
    assert light.sum() > 50  # the title can be read on a dark slide
    assert dark.sum() == 0
