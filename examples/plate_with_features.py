"""Features on a plate: a marked line that the quads follow, beside a pair that bends them."""

import numpy as np

import crossview
from crossview import Case

case = Case.from_json(
    {
        "surface": {"builtin": "rectangle", "width": 2, "height": 1, "columns": 32, "rows": 16},
        "singularities": [
            {"position": [0.45, 0.1, 0.0], "valence": 3},
            {"position": [0.75, -0.1, 0.0], "valence": 5},
        ],
        "features": {"curves": [[[0.0, -0.5, 0.0], [0.0, 0.5, 0.0]]]},
    }
)
problem = crossview.read(case)

for method in ("isotropic", "anisotropic"):
    solution = crossview.solve(problem, method)
    off = np.degrees(np.abs(solution.field.feature_misalignment).max())
    print(f"{method}: {off:.1f} degrees off the line")

mesh = crossview.quads(crossview.layout(solution), target_quads=300)
on_line = np.abs(mesh.vertices[:, 0]) < 1e-9  # a column of vertices from side to side
print(mesh.irregular, np.ptp(mesh.vertices[on_line, 1]))  # {3: 1, 5: 1} 1.0
crossview.write_mesh(mesh, "plate.vtk")
