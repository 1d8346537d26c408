"""Draw the gallery cases that the empty window offers: resources/thumbnails/*.png."""

from pathlib import Path

from PIL import Image

from crossview.cases.gallery import path_of
from crossview.cases.model import Case
from crossview.export.raster import picture
from crossview.gui.empty_state import FEATURED
from crossview.scene import field_view, layers_named
from crossview.workflow.pipeline import Pipeline
from crossview.workflow.problem import Problem
from solvers.progress import run

FOLDER = Path(__file__).parents[1] / "resources" / "thumbnails"
SIZE = (416, 312)


def thumbnail(name: str) -> Image.Image:
    """Draw a gallery case in few strokes, cropped to the surface, on nothing."""
    problem = Problem.from_case(Case.load(path_of(name)))
    solution = run(Pipeline().solve(problem))
    layers = layers_named(("surface", "H", "crosses", "singularities", "boundary"))
    view = field_view(solution.field, layers=layers, background="transparent")
    view = view.with_layer("crosses", density=0.35, size=1.5).with_layer("singularities", size=1.6)
    drawn = picture(view, (1600, 900), 1.0, "auto", texts=False)
    drawn = drawn.crop(drawn.getchannel("A").getbbox())
    drawn.thumbnail(SIZE, Image.Resampling.LANCZOS)
    framed = Image.new("RGBA", SIZE)
    framed.paste(drawn, ((SIZE[0] - drawn.width) // 2, (SIZE[1] - drawn.height) // 2))
    return framed.quantize(200, method=Image.Quantize.FASTOCTREE)


for case, _ in FEATURED:
    thumbnail(case).save(FOLDER / f"{case}.png", optimize=True)
