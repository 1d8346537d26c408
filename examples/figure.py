"""From a surface to a figure: a disk with four valence 3, its sizes and its separatrices."""

import crossview
from crossview import Problem, Singularity, primitives

surface = primitives.disk(edge_length=0.06)
places = [(0.55, 0, 0), (0, 0.55, 0), (-0.55, 0, 0), (0, -0.55, 0)]
four = [Singularity(surface.closest_point(place), valence=3) for place in places]

solution = crossview.solve(Problem(surface, four))
layout = crossview.layout(solution)
print(solution.verdict.status, layout.patches, layout.conforming)  # valid 5 True

shown = ["H", "crosses", "separatrices", "singularities", "boundary", "legend"]
for name in ("figure.png", "figure.pdf"):
    crossview.render(solution, name, layout=layout, layers=shown, size=(800, 600))
