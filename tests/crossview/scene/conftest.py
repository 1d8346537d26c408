"""Plotters off screen, and what their pixels are."""

from collections.abc import Callable, Iterator

import numpy as np
import pytest
from numpy.typing import ArrayLike, NDArray

from crossview.view.colors import rgb
from tests.crossview.scene.stage import Near, Stage


@pytest.fixture
def new_stage() -> Iterator[Callable[[], Stage]]:
    stages: list[Stage] = []

    def make() -> Stage:
        stages.append(Stage())
        return stages[-1]

    yield make
    for stage in stages:
        stage.plotter.close()


@pytest.fixture
def stage(new_stage: Callable[[], Stage]) -> Stage:
    return new_stage()


@pytest.fixture
def near() -> Near:
    """Whether pixels have a colour, up to rounding."""

    def compare(pixels: ArrayLike, color: str, tolerance: int = 3) -> NDArray[np.bool_]:
        wanted = np.round(255.0 * np.array(rgb(color)))
        return np.asarray((np.abs(np.asarray(pixels, float) - wanted) <= tolerance).all(axis=-1))

    return compare
