"""From a surface to a quad mesh: eight irregular vertices at the corners of a cube."""

from itertools import product

import crossview
from crossview import Problem, Singularity, primitives

surface = primitives.cube_sphere(n=16)  # or crossview.read_surface("part.stl")
corners = product((-0.6, 0.6), repeat=3)
cube = [Singularity(surface.closest_point(corner), valence=3) for corner in corners]

solution = crossview.solve(Problem(surface, cube))
mesh = crossview.quads(crossview.layout(solution), target_quads=600)
print(mesh.n_quads, mesh.irregular)  # 600 {3: 8}
print(mesh.scaled_jacobian.min() > 0.8)  # True

for name in ("sphere.obj", "sphere.vtk", "sphere.msh"):
    crossview.write_mesh(mesh, name)
