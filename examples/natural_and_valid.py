"""Natural singularities of a plate with a hole, moved to where they are valid."""

import numpy as np

import crossview
from crossview import Problem, primitives

outline = [(-1, -1), (2, -1), (1.6, 1.1), (-0.8, 0.8)]
angles = 2 * np.pi * np.arange(24) / 24
hole = 0.5 * np.stack([np.cos(angles), np.sin(angles)], axis=1)
surface = primitives.planar(outline, [hole], edge_length=0.12)

natural = crossview.natural(Problem(surface))
valid = crossview.make_valid(natural)
for problem in (natural, valid):
    solution = crossview.solve(problem)
    valences = [s.valence for s in problem.singularities]
    off = np.degrees(np.abs(solution.holonomy_defects).max())
    print(f"valences {valences}, {off:.2f} degrees off: {solution.verdict.status}")

mesh = crossview.quads(crossview.layout(solution), target_quads=500)
print(f"{mesh.n_quads} quads, irregular vertices by valence: {mesh.irregular}")
crossview.write_mesh(mesh, "plate.msh")
crossview.render(solution, "plate.png", layers=["quads", "singularities", "boundary"], quads=mesh)
