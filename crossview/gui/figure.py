"""What a figure shows and how it is drawn."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from crossview.cases.model import Case
from crossview.cases.pictured import Pictured
from crossview.export.apart import packed
from crossview.scene import Camera, SceneView

INCH = 25.4
"""Millimetres."""


@dataclass(frozen=True)
class FigureSettings:
    """How large, how fine and on what a figure is drawn.

    Parameters
    ----------
    size : (int, int)
        Width and height before scaling, pixels.
    scale : int
        Finer by this factor, lines and text scaled with it.
    transparent : bool
        No background.
    dpi : int
        Pixels of the file per inch on paper.
    """

    size: tuple[int, int] = (1600, 1200)
    scale: int = 1
    transparent: bool = False
    dpi: int = 300

    @property
    def millimetres(self) -> tuple[float, float]:
        """Width and height on paper."""
        width, height = (INCH * side * self.scale / self.dpi for side in self.size)
        return width, height


@dataclass(frozen=True, eq=False)
class Figure:
    """What would be written now.

    Parameters
    ----------
    view : SceneView
        What is shown, without what only helps to edit.
    camera : Camera
        From where it is seen.
    settings : FigureSettings
    case : Case
        What it is of; the file carries it.
    """

    view: SceneView
    camera: Camera
    settings: FigureSettings
    case: Case

    def packed(self, path: Path) -> bytes:
        """Return what the process that writes it to a file is sent."""
        return packed(
            self.view,
            path,
            size=self.settings.size,
            scale=self.settings.scale,
            camera=self.camera,
            dpi=self.settings.dpi,
            about=Pictured(self.case, self.camera.text).words(path.parent),
        )
