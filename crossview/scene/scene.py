"""The scene: the layers of one plotter, kept equal to the last view shown."""

from __future__ import annotations

from dataclasses import fields
from typing import Protocol

import numpy as np
import pyvista as pv
from vtkmodules.vtkCommonDataModel import vtkPlane

from crossview.scene.axes import AxesLayer
from crossview.scene.camera import Camera, Room, camera_for
from crossview.scene.crosses import CrossesLayer
from crossview.scene.curves import (
    BoundaryLayer,
    CutLayer,
    FeaturesLayer,
    LoopLayer,
    SectionLayer,
)
from crossview.scene.guide import GuideLayer
from crossview.scene.legend import (
    BAR_ROOM,
    LEGEND_ROOM,
    MARGIN,
    ColorBarLayer,
    TitleLayer,
    ValenceLegendLayer,
    bar_room,
)
from crossview.scene.marks import MarksLayer
from crossview.scene.measure import MeasureLayer
from crossview.scene.near_misses import NearMissesLayer
from crossview.scene.problems import ProblemLayer
from crossview.scene.quads import QuadsLayer
from crossview.scene.separatrices import SeparatricesLayer
from crossview.scene.singularities import SingularitiesLayer
from crossview.scene.surface import SurfaceLayer
from crossview.scene.watch import Watch
from crossview.view.colors import THEMES, rgb
from crossview.view.geometry import FloatArray, IntArray, Triangles
from crossview.view.scalars import Beyond, beyond, quality_limits, shown_scalar
from crossview.view.scene_view import SceneView
from crossview.view.values import Plane

LIGHT = (-0.3, 0.4, 1.0)
"""Where the light is in the camera's frame: left of the eye, above and behind it. Chosen."""


_BESIDE = 1e-3
"""How far before its plane clipping begins, in diagonals of the surface. Chosen."""


class Layer(Protocol):
    """A part of the picture that keeps itself equal to the last view shown."""

    def __init__(self, plotter: pv.BasePlotter, pixel_ratio: float) -> None: ...

    def show(self, view: SceneView, triangles: Triangles | None) -> None:
        """Apply what changed."""

    def remove(self) -> None:
        """Take it off the plotter."""


class Scene:
    """Shows views on a plotter.

    Parameters
    ----------
    plotter : pyvista plotter
        Empty; its lights and background become the scene's.
    pixel_ratio : float
        Device pixels per pixel: widths of lines and sizes of texts are multiplied by it.
    texts : bool
        Whether title, legend, colour bar and axes are drawn; their room is kept anyway.
    """

    def __init__(
        self, plotter: pv.BasePlotter, pixel_ratio: float = 1.0, texts: bool = True
    ) -> None:
        self._plotter = plotter
        self._ratio = pixel_ratio
        self._watch = Watch()
        self._view = SceneView()
        self._triangles: Triangles | None = None
        _light(plotter)
        # VTK blends in no order by default, which leaves specks under multi-sampling.
        plotter.renderer.SetUseOIT(False)
        self._surface = SurfaceLayer(plotter, pixel_ratio)
        self._bar = ColorBarLayer(plotter, pixel_ratio) if texts else None
        kinds: tuple[type[Layer], ...] = (
            QuadsLayer,
            CrossesLayer,
            SeparatricesLayer,
            FeaturesLayer,
            BoundaryLayer,
            SectionLayer,
            CutLayer,
            LoopLayer,
            NearMissesLayer,
            GuideLayer,
            MarksLayer,
            SingularitiesLayer,
            ProblemLayer,
        )
        if texts:
            kinds += (MeasureLayer, TitleLayer, ValenceLegendLayer, AxesLayer)
        self._layers: tuple[Layer, ...] = (
            self._surface,
            *(kind(plotter, pixel_ratio) for kind in kinds),
        )
        self.show(self._view)

    @property
    def h_range(self) -> tuple[float, float]:
        """The limits of the colours of H last shown."""
        return self._surface.h_range

    @property
    def limits(self) -> tuple[float, float]:
        """The limits of the colours of the scalar shown; of the error density powers of 10."""
        quads = self._view.quads
        if shown_scalar(self._view) == "quads" and quads and quads.quality is not None:
            return quality_limits(self._view.layer("quads"), quads.quality)
        return self._surface.limits

    @property
    def beyond(self) -> Beyond:
        """Whether the scalar shown is below its limits somewhere, and whether above."""
        quads = self._view.quads
        if shown_scalar(self._view) == "quads" and quads and quads.quality is not None:
            return beyond(quads.quality, self.limits)
        return self._surface.beyond

    def show(self, view: SceneView) -> bool:
        """Show a view: touch only what changed since the last one.

        Returns
        -------
        bool
            Whether the picture may differ, i.e. the plotter is to render.
        """
        if not self._watch.changed("view", *(getattr(view, f.name) for f in fields(view))):
            return False
        if self._watch.changed("surface", view.points, view.faces, view.triangles):
            self._triangles = view.triangles or _drawable(view.points, view.faces)
        if self._watch.changed("background", view.background):
            self._plotter.renderer.SetBackground(*rgb(THEMES[view.background].background))
        for layer in self._layers:
            layer.show(view, self._triangles)
        if self._watch.changed("clip", view.clip):
            self._clip(view.clip)
        self._view = view
        if self._bar is not None:
            self._bar.show_range(view, self.limits, self.beyond)
        return True

    @property
    def camera(self) -> Camera:
        """The camera as it is now."""
        return Camera.of(self._plotter.renderer.GetActiveCamera())

    def fit(self, camera: str | Camera = "auto", all_texts: bool = False) -> None:
        """Set the camera so that the surface fills the room between the texts.

        Parameters
        ----------
        camera : str or Camera
            As `camera.camera_for` reads it; a `Camera` is taken as it is.
        all_texts : bool
            Keep room also for texts that are not shown yet, so that they may come and go.
        """
        if self._triangles is None:
            return
        if isinstance(camera, str):
            camera = camera_for(camera, self._triangles, self._room(all_texts))
        camera.apply(self._plotter.renderer.GetActiveCamera())
        self._plotter.renderer.ResetCameraClippingRange()
        # Else pyvista chooses its own view before the first frame.
        self._plotter.camera_set = True

    def smooth(self, on: bool) -> None:
        """Smooth edges and lines from the next frame on, or no longer.

        For a picture at rest where multi-sampling is off: costs some 20 ms on a processor.
        """
        self._plotter.renderer.SetUseFXAA(on)

    def remove(self) -> None:
        """Take everything off the plotter."""
        for layer in self._layers:
            layer.remove()
        if self._bar is not None:
            self._bar.remove()

    def _clip(self, plane: Plane | None) -> None:
        for actor in self._plotter.renderer.GetActors():
            mapper = actor.GetMapper()
            mapper.RemoveAllClippingPlanes()
            if plane is not None and self._triangles is not None:
                behind = vtkPlane()
                # a little before it, so that the line where it meets the surface is whole
                behind.SetOrigin(*plane.moved(_BESIDE * self._triangles.diagonal).place)
                behind.SetNormal(*(-part for part in plane.normal))
                mapper.AddClippingPlane(behind)

    def _room(self, all_texts: bool) -> Room:
        return room_for(self._view, self._plotter.window_size, self._ratio, all_texts)


def room_for(view: SceneView, size: tuple[int, int], ratio: float, all_texts: bool = False) -> Room:
    """Return what the texts of a view leave free of a picture.

    Parameters
    ----------
    view : SceneView
    size : (int, int)
        Of the picture, pixels.
    ratio : float
        Pixels of the picture per pixel of the window.
    all_texts : bool
        Keep room also for texts that are not shown yet.
    """
    shown = shown_scalar(view)
    right = bar_room(shown) if shown else BAR_ROOM if all_texts else MARGIN
    return Room(
        *size,
        left=MARGIN * ratio,
        right=right * ratio,
        top=(2.2 if view.title else 1.0) * MARGIN * ratio,
        bottom=(LEGEND_ROOM if all_texts or view.singularities else MARGIN) * ratio,
    )


def _light(plotter: pv.BasePlotter) -> None:
    """One light from over the eye's left shoulder: each more costs an eighth of a frame.

    What faces the eye is lit by exactly 1: a planar figure shows its colours as they are.
    """
    plotter.remove_all_lights()
    facing = LIGHT[2] / float(np.linalg.norm(LIGHT))
    light = pv.Light(light_type="camera light", intensity=1.0 / facing)
    light.position = LIGHT
    plotter.add_light(light)


def _drawable(points: FloatArray | None, faces: IntArray | None) -> Triangles | None:
    """Return the triangles with their numbers kept and none that would upset the renderer."""
    if points is None or faces is None or not len(points) or not len(faces):
        return None
    finite = np.logical_and.reduce(np.isfinite(points), axis=1)
    if not finite.any():
        return None
    points = np.where(finite[:, None], points, points[finite].mean(axis=0))
    inside = np.logical_and.reduce((faces >= 0) & (faces < len(points)), axis=1)
    return Triangles(points, np.where(inside[:, None], faces, 0))
