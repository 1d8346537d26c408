"""What solve makes is judged by the certificate, and the report carries what it finds."""

from __future__ import annotations

import json
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import crossview as library
from crossview.export.quads_report import quads_report, quads_summary
from crossview.gui.panels.quad_facts import quad_facts
from crossview.workflow.certification import certified, own_surface, worth
from solvers.quads.projection import Projection
from tests.command_line import Crossview


@cache
def made() -> tuple[library.Solution, library.QuadLayout, library.QuadMesh]:
    solution = library.solve(library.read("disk-4"))
    layout = library.layout(solution)
    return solution, layout, library.quads(layout, 300)


def test_the_report_carries_what_check_says_of_the_file(
    crossview: Crossview, tmp_path: Path
) -> None:
    options = ["--quads", "--target-quads", "1500", "-o", tmp_path / "out"]
    assert crossview("solve", "disk-4", *options).status == 0
    told = json.loads((tmp_path / "out" / "report.json").read_text())["quads"]["certificate"]
    asked = ["--case", "disk-4", "--target-quads", "1500", "--json"]
    found = crossview("check", tmp_path / "out" / "quads.obj", *asked).json
    assert told["right"]
    assert told.pop("sizes")["slope"] == pytest.approx(1, abs=0.05)
    assert _rounded(told) == _rounded(found)


def _rounded(value: Any) -> Any:
    """Numbers as a file of nine digits has them."""
    if isinstance(value, dict):
        return {key: _rounded(member) for key, member in value.items()}
    return round(value, 4) if isinstance(value, float) else value


def test_what_is_no_quad_is_counted() -> None:
    solution, layout, mesh = made()
    assert quads_report(solution, mesh)["non_quads"] == 0
    quads = mesh.quads.copy()
    quads[0, 1] = quads[0, 0]
    broken = replace(mesh, quads=quads)
    told = quads_report(solution, broken)
    assert told["non_quads"] == 1
    assert not told["certificate"]["right"]
    assert "1 face with a vertex twice" in quads_summary(solution, layout, broken)


def test_an_inverted_quad_is_told() -> None:
    solution, layout, mesh = made()
    inner = next(v for v in range(mesh.n_vertices) if not mesh.on_boundary[v])
    vertices = mesh.vertices.copy()
    vertices[inner] = mesh.vertices[mesh.quads[(mesh.quads == inner).any(axis=1)][0]].mean(axis=0)
    quad = mesh.quads[(mesh.quads == inner).any(axis=1)][0]
    across = quad[(list(quad).index(inner) + 2) % 4]
    vertices[inner] += 0.6 * (mesh.vertices[across] - vertices[inner])
    spoiled = replace(mesh, vertices=vertices)
    assert quads_report(solution, spoiled)["inverted"] >= 1
    told = quads_summary(solution, layout, spoiled)
    assert "inverted face" in told
    assert told.endswith("try another number of quads")


def test_meshes_are_compared_as_the_certificate_judges_them() -> None:
    mesh = made()[2]
    surface = own_surface(mesh.surface)
    good = worth(mesh, surface)
    assert (good.upright, good.met, good.fewest) == (True, True, 0)
    assert mesh.quantization is not None
    missed = replace(mesh, quantization=replace(mesh.quantization, n_wanted=2 * mesh.n_quads))
    vertices = mesh.vertices.copy()
    inner = int(mesh.quads[~mesh.on_boundary[mesh.quads].any(axis=1)][0, 0])
    vertices[inner] += 3 * mesh.edge_lengths.max()
    folded = worth(replace(mesh, vertices=vertices), surface)
    assert not folded.upright
    assert folded.fewest < 0
    assert good > worth(missed, surface) > folded


def test_a_straight_corner_at_a_valence_2_is_no_reason_for_another_mesh() -> None:
    square = library.read("square").surface
    places = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0.6, 0.4, 0]])
    places += square.vertices.min(axis=0)
    faces, weights = Projection(square).nearest(places)
    fixed, loop = np.zeros(5, dtype=bool), np.array([0, 0, 0, 0, -1])
    quads = np.array([[0, 1, 2, 4], [0, 4, 2, 3]])
    mesh = library.QuadMesh(square, places, quads, np.zeros(2, int), faces, weights, fixed, loop)
    assert mesh.scaled_jacobian.min() < 0
    assert worth(mesh, own_surface(square)).upright


def test_a_mesh_that_cuts_the_surface_off_is_told_wrong_in_summary_panel_and_report() -> None:
    # a sphere of one quad to each side of a cube: 44 % of its area
    solution = library.solve(library.read("sphere-cube"))
    layout = library.layout(solution)
    mesh = library.quads(layout, 6)
    certificate = certified(solution, mesh)
    (fault,) = certificate.faults
    assert fault.kind == "area"
    assert str(fault) in quads_summary(solution, layout, mesh)
    facts = quad_facts(layout, mesh, solution, certificate)
    assert not facts.good
    assert str(fault)[1:] in facts.verdict
    assert not quads_report(solution, mesh)["certificate"]["right"]
