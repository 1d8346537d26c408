"""Draw the pictures of the gallery that the window shows: resources/thumbnails/*.png.

usage: python tools/thumbnails.py [CASE ...]
"""

import sys
from dataclasses import replace
from pathlib import Path
from tempfile import mkdtemp

from PIL import Image

from crossview.cases.gallery import RESOURCES, exhibits
from crossview.export.raster import picture
from crossview.scene import field_view, layers_named
from crossview.studies.exhibition import performed
from crossview.studies.performing import State
from crossview.view.meshes import curves_of

SIZE = (416, 312)
LAYERS = ("surface", "H", "crosses", "singularities", "boundary", "separatrices")


def thumbnail(state: State) -> Image.Image:
    """Draw what was made of a case in few strokes, cropped to the surface, on nothing."""
    if state.solution is None:
        raise ValueError("nothing is solved")
    view = field_view(state.solution.field, layers=layers_named(LAYERS), transparent=True)
    if state.layout is not None:
        view = replace(view, separatrices=curves_of(state.layout.separatrices))
    view = view.with_layer("crosses", density=0.35, size=1.5).with_layer("singularities", size=1.6)
    drawn = picture(view, (1600, 900), 1.0, "auto", texts=False)
    drawn = drawn.crop(drawn.getchannel("A").getbbox())
    drawn.thumbnail(SIZE, Image.Resampling.LANCZOS)
    framed = Image.new("RGBA", SIZE)
    framed.paste(drawn, ((SIZE[0] - drawn.width) // 2, (SIZE[1] - drawn.height) // 2))
    return framed.quantize(200, method=Image.Quantize.FASTOCTREE)


for exhibit in exhibits():
    if len(sys.argv) == 1 or exhibit.case in sys.argv[1:]:
        made = performed(exhibit, Path(mkdtemp()))
        thumbnail(made).save(RESOURCES / "thumbnails" / f"{exhibit.case}.png", optimize=True)
