"""crossview check: meshes of anyone against a surface, by files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import pyvista as pv

from tests.command_line import CaseFile, Crossview, refused

N = 6


def squares(path: Path, lift: float = 0.0) -> Path:
    """N x N quads on the unit square about the origin, the middle vertex lifted."""
    t = np.linspace(-0.5, 0.5, N + 1)
    places = [(x, y, lift * (x == y == 0)) for y in t for x in t]
    quads = [
        [j * (N + 1) + i, j * (N + 1) + i + 1, (j + 1) * (N + 1) + i + 1, (j + 1) * (N + 1) + i]
        for j in range(N)
        for i in range(N)
    ]
    faces = np.insert(np.array(quads), 0, 4, axis=1)
    if path.suffix == ".obj":
        lines = [f"v {x} {y} {z}" for x, y, z in places]
        lines += ["f " + " ".join(str(v + 1) for v in quad) for quad in quads]
        path.write_text("\n".join(lines))
    else:
        pv.PolyData(np.array(places), faces.reshape(-1)).save(path)
    return path


@pytest.mark.parametrize("ending", [".obj", ".vtk", ".ply"])
def test_a_mesh_of_another_program(
    crossview: Crossview, case_file: CaseFile, tmp_path: Path, ending: str
) -> None:
    surface = case_file({"builtin": "square", "size": 1.0})
    right = squares(tmp_path / f"right{ending}")
    ran = crossview("check", right, "--against", surface)
    assert ran.status == 0, ran.err
    assert ran.out.startswith(f"{right}: {N * N} quads, right\n")
    wrong = squares(tmp_path / f"wrong{ending}", lift=0.3)
    ran = crossview("check", wrong, "--against", surface)
    assert ran.status == 1
    assert "a face is 1.8 edges off the surface, at (0, 0, 0.3)" in ran.out
    report = crossview("check", wrong, "--against", surface, "--json").json
    assert not report["right"]
    assert "surface" in {fault["kind"] for fault in report["faults"]}
    assert report["counts"]["quads"] == N * N


def test_quads_of_a_case_have_its_singularities(crossview: Crossview, tmp_path: Path) -> None:
    options = ["--quads", "--target-quads", "300", "-o", tmp_path / "out"]
    assert crossview("solve", "disk-4", *options).status == 0
    quads = tmp_path / "out" / "quads.vtk"
    assert crossview("check", quads, "--case", "disk-4", "--target-quads", "300").status == 0
    ran = crossview("check", quads, "--case", "square", "--against", "disk-4")
    assert ran.status == 1
    assert "too many, the first, of 3 faces" in ran.out


def test_quads_follow_features(crossview: Crossview, tmp_path: Path) -> None:
    # the unit square folded by 90 degrees along a line through the middles of a row of quads
    lines = ["v -0.5 0 0.5", "v -0.5 1 0.5", "v 0 0 0", "v 0 1 0", "v 0.5 0 0.5", "v 0.5 1 0.5"]
    surface = tmp_path / "surface.obj"
    surface.write_text("\n".join([*lines, "f 1 3 4 2", "f 3 5 6 4"]))
    for name, x in (("along", [-0.5, 0, 0.5]), ("across", [-0.5, -0.25, 0.25, 0.5])):
        n = len(x)
        lines = [f"v {a} {y} {abs(a)}" for y in (0, 0.5, 1) for a in x]
        corners = [(j * n + i, j * n + i + 1) for j in range(2) for i in range(n - 1)]
        lines += [f"f {a + 1} {b + 1} {b + n + 1} {a + n + 1}" for a, b in corners]
        (tmp_path / "quads.obj").write_text("\n".join(lines))
        asked = ["check", tmp_path / "quads.obj", "--against", surface, "--features", "40"]
        ran = crossview(*asked)
        assert ("off all edges" in ran.out) == (name == "across")


def test_mistakes_are_told(crossview: Crossview, tmp_path: Path) -> None:
    mesh = squares(tmp_path / "quads.obj")
    refused(crossview("check", mesh), tmp_path, "nothing to check against", "--against")
    refused(crossview("check", "no.obj", "--against", "square"), tmp_path, "no.obj")
    refused(crossview("check", mesh, "--against", "no"), tmp_path, "no")
    (tmp_path / "points.obj").write_text("v 0 0 0\n")
    refused(
        crossview("check", tmp_path / "points.obj", "--against", "square"), tmp_path, "points.obj"
    )
    (tmp_path / "bad.obj").write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3 9\n")
    refused(crossview("check", tmp_path / "bad.obj", "--against", "square"), tmp_path, "bad.obj")
