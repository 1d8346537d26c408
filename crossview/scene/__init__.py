"""What is drawn, on any pyvista plotter: the window's or an off-screen one.

Use::

    ensure_rendering()                      # before the first plotter of the process
    scene = Scene(plotter)                  # takes an empty plotter; pixel_ratio for HiDPI
    scene.show(SceneView(points, faces, H=H, u=u, v=v, singularities=(Marker((0, 0, 1), 3),)))
    scene.fit()                             # camera: a good first view of what is shown
    plotter.render()                        # show() never renders; it returns whether to
    ...
    view = replace(view, H=new_H, u=new_u, v=new_v)     # a drag: new arrays, the rest the same
    if scene.show(view):                                # only what changed is touched, in place
        plotter.render()
    view = view.with_layer("crosses", density=2.0)      # a slider in the Layers panel
    scene.smooth(True); plotter.render()    # at rest, on a software renderer; off for a drag
    scene.remove()                          # takes every actor and observer back

`SceneView` is one frozen value: data and per-layer settings. `Scene.show` compares it with the
last one (arrays by identity, all else by equality) and each layer applies what concerns it.
`LAYERS` lists the layers with the settings each listens to; `default_layers()` their defaults.
`scene.h_range` is the colour range in use: put it in the H layer's `value_range` to hold it still.
`field_view(field, ...)` makes the view of a solved `CrossField`.
Only the thread that owns the plotter may call the scene.
"""

from crossview.scene.camera import Camera
from crossview.scene.display import ensure_rendering, renderer_name, software_renderer
from crossview.scene.scene import Scene
from crossview.view.field import field_view
from crossview.view.scene_view import (
    LAYERS,
    LayerKind,
    LayerSettings,
    SceneView,
    default_layers,
    layers_named,
)
from crossview.view.values import Elements, GuideLine, Marker, Polylines, Quads

__all__ = [
    "LAYERS",
    "Camera",
    "Elements",
    "GuideLine",
    "LayerKind",
    "LayerSettings",
    "Marker",
    "Polylines",
    "Quads",
    "Scene",
    "SceneView",
    "default_layers",
    "ensure_rendering",
    "field_view",
    "layers_named",
    "renderer_name",
    "software_renderer",
]
