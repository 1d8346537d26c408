"""Impose singularities on a surface, solve its boundary-aligned cross-field, and see it live.

The same verbs as on the command line and in the window, from a file to a quad mesh::

    import crossview

    problem = crossview.make_valid(crossview.natural(crossview.read("part.obj")))
    solution = crossview.solve(problem)
    layout = crossview.layout(solution)
    mesh = crossview.quads(layout, 2000)
    crossview.write_mesh(mesh, "quads.msh")
    crossview.render(solution, "figure.pdf", layout=layout, quads=mesh)

The numerics below them are `solvers`; Qt and VTK are loaded when they are wanted.
"""

from __future__ import annotations

from importlib.metadata import version

from solvers.lazy import names_of_stub

__version__ = version("crossview")
__getattr__, __dir__, __all__ = names_of_stub(__name__)
