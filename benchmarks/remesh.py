"""One peer on one surface, in a process of its own: peers may crash or never end.

    python -m benchmarks.remesh PEER IN.npz OUT.npz

IN has vertices (n, 3), faces (m, 3) and the number of quads wanted; OUT gets vertices (k, 3),
faces (f, 3) and (f, 4), and the seconds of the peer's own work.
"""

from __future__ import annotations

import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

FACES = {3: "triangles", 4: "quads"}
Raw = tuple[np.ndarray, list[list[int]]]


def instant_meshes(
    vertices: NDArray[np.float64], faces: NDArray[np.int64], wanted: int
) -> tuple[Raw, float]:
    """Instant Meshes, pure quads; only its file output keeps them."""
    import pyinstantmeshes

    with tempfile.TemporaryDirectory() as folder:
        given, made = Path(folder, "in.obj"), Path(folder, "out.obj")
        rows = ["v {:.9g} {:.9g} {:.9g}".format(*v) for v in vertices]
        rows += ["f {} {} {}".format(*f) for f in faces + 1]
        given.write_text("\n".join(rows) + "\n")
        start = time.perf_counter()
        pyinstantmeshes.remesh_file(
            str(given),
            str(made),
            target_face_count=wanted // 4,  # each face is cut into four to have quads alone
            align_to_boundaries=True,
            pure_quad=True,
            deterministic=True,
        )
        seconds = time.perf_counter() - start
        words = [line.split() for line in made.read_text().splitlines()]
    points = np.array([w[1:4] for w in words if w[:1] == ["v"]], dtype=float)
    polygons = [[int(c.split("/")[0]) - 1 for c in w[1:]] for w in words if w[:1] == ["f"]]
    return (points, polygons), seconds


def quadriflow(
    vertices: NDArray[np.float64], faces: NDArray[np.int64], wanted: int
) -> tuple[Raw, float]:
    """QuadriFlow as Blender has it, boundaries kept."""
    from pyQuadriFlow.pyQuadriFlow import pyquadriflow

    given = vertices.tolist(), faces.tolist()
    start = time.perf_counter()
    made = pyquadriflow(wanted, 0, *given, False, True, False, False, False)
    return (np.array(made["vertices"]), made["faces"]), time.perf_counter() - start


def gmsh_quasi_structured(
    vertices: NDArray[np.float64], faces: NDArray[np.int64], wanted: int
) -> tuple[Raw, float]:
    """Gmsh's quasi-structured quads on the reparametrised triangulation."""
    import gmsh

    area = (
        np.linalg.norm(
            np.cross(
                vertices[faces[:, 1]] - vertices[faces[:, 0]],
                vertices[faces[:, 2]] - vertices[faces[:, 0]],
            ),
            axis=1,
        ).sum()
        / 2
    )
    size = 2 * float(np.sqrt(area / wanted))  # quads are the quarters of faces of that size
    gmsh.initialize(interruptible=False)
    gmsh.option.set_number("General.Terminal", 0)
    start = time.perf_counter()
    gmsh.model.add("surface")
    gmsh.model.add_discrete_entity(2, 1)
    gmsh.model.mesh.add_nodes(2, 1, np.arange(1, len(vertices) + 1), vertices.reshape(-1))
    gmsh.model.mesh.add_elements_by_type(1, 2, [], (faces + 1).reshape(-1))
    # one smooth surface; boundaries break at their corners
    gmsh.model.mesh.classify_surfaces(np.radians(180), True, True, np.pi)
    gmsh.model.mesh.create_geometry()
    gmsh.model.geo.synchronize()
    gmsh.option.set_number("Mesh.Algorithm", 11)
    gmsh.option.set_number("Mesh.MeshSizeMin", size)
    gmsh.option.set_number("Mesh.MeshSizeMax", size)
    gmsh.option.set_number("Mesh.MeshSizeFromPoints", 0)
    gmsh.model.mesh.generate(2)
    seconds = time.perf_counter() - start
    tags, points, _ = gmsh.model.mesh.get_nodes()
    number = dict(zip(tags.tolist(), range(len(tags)), strict=True))
    polygons = []
    for kind, corners in ((2, 3), (3, 4)):
        nodes = gmsh.model.mesh.get_elements_by_type(kind)[1].reshape(-1, corners)
        polygons += [[number[i] for i in row] for row in nodes.tolist()]
    gmsh.finalize()
    return (points.reshape(-1, 3), polygons), seconds


PEERS = {
    "Instant Meshes": instant_meshes,
    "QuadriFlow": quadriflow,
    "gmsh quasi-structured": gmsh_quasi_structured,
}


def main(peer: str, given: str, made: str) -> None:
    with np.load(given) as surface:
        (points, polygons), seconds = PEERS[peer](
            surface["vertices"], surface["faces"], int(surface["wanted"])
        )
    used, numbers = np.unique(np.concatenate([np.array(p) for p in polygons]), return_inverse=True)
    sizes = np.array([len(p) for p in polygons])
    starts = np.cumsum(sizes) - sizes
    arrays = {
        name: numbers[starts[sizes == n][:, None] + np.arange(n)] for n, name in FACES.items()
    }
    np.savez(made, vertices=points[used], seconds=seconds, **arrays)


if __name__ == "__main__":
    main(*sys.argv[1:])
