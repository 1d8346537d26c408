"""Separatrices, layout and quads of one field, and separatrices while it changes."""

import time
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from crossview.cases.gallery import path_of
from crossview.cases.model import Case
from crossview.session.document import Document
from crossview.session.live import LiveBase, LiveEdit
from crossview.session.live_tracer import LiveTracer
from crossview.session.meshes import NO_MESHES, lay_out, make_quads, trace
from crossview.workflow.pipeline import Pipeline, Solution
from crossview.workflow.problem import Problem
from crossview.workflow.quads import MeshOptions
from solvers.progress import Progress, run


def solved(name: str, **changes: Any) -> Solution:
    problem = Problem.from_case(Case.load(path_of(name)))
    return run(Pipeline().solve(replace(problem, **changes)))


@pytest.fixture(scope="module")
def cube() -> Solution:
    return solved("sphere-cube")


def test_twelve_arcs_of_the_cube_are_traced_exactly(cube: Solution) -> None:
    made = run(lay_out(cube, NO_MESHES))
    assert made.of is cube.field
    assert made.settled
    assert made.layout.patches == 6
    assert len(made.separatrices.valences) == 12
    assert len(made.misaligned) == 0
    assert run(trace(cube, made)).layout is made.layout


def test_quads_bring_their_layout_and_rise_steadily(cube: Solution) -> None:
    steps: list[Progress] = []
    options = MeshOptions(target_quads=600)
    made = run(make_quads(cube, NO_MESHES, options), steps.append)
    assert made.quads.irregular == {3: 8}
    assert abs(made.quads.n_quads - 600) < 60
    assert made.options is options
    fractions = [step.fraction for step in steps]
    assert fractions == sorted(fractions)
    assert fractions[-1] <= 1.0
    # other quads on the layout that is there
    finer = run(make_quads(cube, made, MeshOptions(target_quads=1200)))
    assert finer.layout is made.layout
    assert finer.quads.n_quads > made.quads.n_quads


def test_what_prevents_a_layout_is_part_of_the_result() -> None:
    plate = solved("suboptimal-a")
    made = run(lay_out(plate, NO_MESHES))
    assert made.layout is None
    assert "misses" in made.trouble.what
    assert len(made.misaligned) == 2
    assert len(made.separatrices.t_junctions) > 0
    assert run(make_quads(plate, made, MeshOptions())).quads is None


@pytest.fixture(scope="module")
def edit(cube: Solution) -> LiveEdit:
    document = Document.from_case("cube", Case.load(path_of("sphere-cube")))
    return LiveEdit.start(document, LiveBase.from_solution(cube))


def test_a_drag_is_traced_at_once_and_then_with_pauses(edit: LiveEdit) -> None:
    tracer = LiveTracer()
    first = run(tracer.follow(edit, True))
    assert first.separatrices.surface is edit.base.surface
    assert np.bincount(first.separatrices.valences)[3] == len(first.separatrices.valences)
    assert not tracer.ready  # the field comes first
    assert run(tracer.follow(edit, True)).separatrices is None
    assert run(tracer.catch_up(first.field)).separatrices is not None
    assert run(LiveTracer().follow(edit, False)).separatrices is None


def test_what_takes_long_waits_for_the_mouse_to_rest(
    edit: LiveEdit, monkeypatch: pytest.MonkeyPatch
) -> None:
    tracer = LiveTracer()
    real = time.thread_time
    monkeypatch.setattr(time, "thread_time", lambda: 100.0 * real())
    run(tracer.follow(edit, True))
    later = time.monotonic() + 1e6
    monkeypatch.setattr(time, "monotonic", lambda: later)
    assert not tracer.ready
