"""The methods beside the isotropic one: what each reaches is in its report, and what is not too."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import pyvista as pv

from crossview.cases.model import Builtin, Case, Options, PlacedSingularity
from crossview.export.report import report, summary
from crossview.workflow.pipeline import Pipeline, Solution, solve_case
from crossview.workflow.problem import Problem
from crossview.workflow.sizes import refined_sizes
from solvers.errors import CrossviewError
from solvers.fields.crossfield import CrossField
from solvers.fields.integrable import FieldStep, alternating_field
from solvers.primitives import BUILTIN
from solvers.progress import Progress, run
from solvers.surface.refinement import refine_at
from tests.command_line import CaseFile, Crossview, Ran

ANNULUS = {"builtin": "annulus", "n": 48}
OPTIONS = Options(refine=0)


def around(degrees: float, radius: float) -> tuple[float, float, float]:
    return (radius * np.cos(np.radians(degrees)), radius * np.sin(np.radians(degrees)), 0.0)


def placed(off: float) -> list[tuple[tuple[float, float, float], int]]:
    """Four valence 3, and as many valence 5 each turned by `off` degrees from the valence 3."""
    pairs = [(around(90 * i, 0.8), 3) for i in range(4)]
    return pairs + [(around(90 * i + off, 0.6), 5) for i in range(4)]


def annulus(method: str, off: float = 12, options: Options = OPTIONS) -> Case:
    """Holonomy defect: as many degrees as `off`, up to quarter turns."""
    singularities = tuple(PlacedSingularity(p, v) for p, v in placed(off))
    return Case(Builtin("annulus", {"n": 48}), singularities, None, method, options)


def solved(case: Case) -> Solution:
    (solution,) = run(solve_case(case))
    return solution


@pytest.fixture(scope="module")
def anisotropic() -> Solution:
    return solved(annulus("anisotropic"))


def test_aligned_is_aligned_but_has_no_map() -> None:
    solution = solved(annulus("aligned"))
    told = report(solution)
    assert np.abs(told["boundary_misalignment_degrees"]).max() < np.degrees(1e-9)
    assert told["energy_initial"] == told["energy_final"] > 0.1
    assert (told["energy_history"], told["iterations"], told["converged"]) == ([], 0, True)
    assert (told["verdict"], told["flips"]) == ("not found", None)
    assert "not integrable" in told["verdict_reason"]


def test_anisotropic_is_aligned_and_integrable(anisotropic: Solution) -> None:
    told = report(anisotropic)
    assert np.abs(told["boundary_misalignment_degrees"]).max() < np.degrees(1e-9)
    assert told["energy_initial"] == pytest.approx(solved(annulus("aligned")).field.energy)
    assert told["energy_history"][0] == told["energy_initial"]
    assert told["energy_history"][-1] == pytest.approx(told["energy_final"], abs=1e-12)
    assert told["energy_final"] <= 1e-10
    assert told["iterations"] == len(told["energy_history"]) - 1 > 0
    assert told["converged"]
    assert told["verdict"] == "valid"
    assert told["flips"] == 0
    assert 0 < told["max_log_aspect"] < 3


@pytest.mark.parametrize("method", ["isotropic", "aligned", "anisotropic"])
def test_the_report_tells_the_isotropic_defects_whatever_the_method(method: str) -> None:
    told = report(solved(annulus(method)))
    (condition,) = told["holonomy"]
    assert abs(condition["defect_degrees"]) == pytest.approx(12, abs=0.05)
    assert not told["isotropically_valid"]
    assert told["method"] == method


def test_isotropic_has_no_error_but_is_not_aligned() -> None:
    told = report(solved(annulus("isotropic")))
    assert (told["energy_final"], told["max_log_aspect"], told["flips"]) == (0, 0, None)
    assert told["verdict"] == "not found"
    assert "12 degrees" in told["verdict_reason"]


def test_the_paper_alternation_that_stalls_is_told_and_no_crash(
    crossview: Crossview, tmp_path: Path, case_file: CaseFile
) -> None:
    path = case_file(ANNULUS, placed(37), method="alternating", options={"refine": 0})
    ran = crossview("solve", path, "-o", tmp_path / "out")
    assert ran.status == 0
    told = json.loads((tmp_path / "out" / "report.json").read_text())
    assert not told["converged"]
    assert 1e-3 < told["energy_final"] < told["energy_initial"]
    assert told["verdict"] == "not found"
    assert ran.out.startswith("not found: alternating, index 0 of 0, E ")
    assert "not converged" in ran.out


def test_the_proximal_weight_is_the_cases() -> None:
    paper, light = (
        solved(annulus("alternating", options=replace(OPTIONS, proximal_weight=w)))
        for w in (1.0, 1e-3)
    )
    for solution, weight in ((paper, 1.0), (light, 1e-3)):
        assert solution.integrated is not None
        again = run(alternating_field(solution.integrated.aligned, weight))
        assert again.field.energy == pytest.approx(solution.field.energy, rel=1e-6)
    assert abs(light.field.energy / paper.field.energy - 1) > 0.01


def test_the_summary_says_method_energy_steps_and_verdict(anisotropic: Solution) -> None:
    steps = len(anisotropic.field.convergence.energies) - 1
    assert summary(anisotropic).startswith("valid: anisotropic, index 0 of 0, E 0.")
    assert f", {steps} steps" in summary(anisotropic)
    assert "\n" not in summary(anisotropic)


def test_paraview_finds_sizes_and_errors(
    crossview: Crossview, tmp_path: Path, case_file: CaseFile
) -> None:
    path = case_file(ANNULUS, placed(12), method="isotropic", options={"refine": 0})
    for method in ("aligned", "anisotropic"):
        out = tmp_path / method
        assert crossview("solve", path, "-o", out, "--method", method).status == 0
        told = json.loads((out / "report.json").read_text())
        surface = pv.read(out / "surface.vtp")
        cells = surface.cell_data
        assert np.allclose(cells["log_aspect"], np.abs(cells["H2"] - cells["H1"]))
        mean = surface.point_data_to_cell_data().cell_data["H"]
        assert np.allclose((cells["H1"] + cells["H2"]) / 2, mean, atol=1e-6)
        areas = surface.compute_cell_sizes().cell_data["Area"]
        error = np.sqrt((areas * cells["error_density"]).sum())
        assert error == pytest.approx(told["energy_final"], abs=1e-9)
        lines = pv.read(out / "crosses.vtp")
        assert np.array_equal(lines.cell_data["H"][::2], cells["H1"])
        lengths = lines.compute_cell_sizes().cell_data["Length"]
        ratio = lengths[1::2] / lengths[::2]
        assert np.allclose(np.log(ratio), cells["H2"] - cells["H1"], atol=1e-6)


def test_other_turns_are_another_layout() -> None:
    one = solved(annulus("anisotropic", options=replace(OPTIONS, turns=(-1,))))
    assert one.field.convergence.energies[0] > 1
    assert np.abs(one.field.boundary_misalignment).max() < 1e-9


class TestSizes:
    """A size map belongs to the vertices of the surface given."""

    def square(
        self,
        sizes: object,
        tmp_path: Path,
        crossview: Crossview,
        case_file: CaseFile,
        **more: object,
    ) -> Ran:
        path = case_file(
            {"builtin": "square", "n": 8},
            method="anisotropic",
            options={"sizes": sizes, **more},
        )
        return crossview("solve", path, "-o", tmp_path / "out")

    def test_numbers_pairs_and_files_say_the_same(
        self, tmp_path: Path, crossview: Crossview, case_file: CaseFile
    ) -> None:
        x, y, _ = BUILTIN["square"](n=8).vertices.T
        sizes = np.exp(np.stack([0.5 * x, 0.3 * y], axis=1))
        np.save(tmp_path / "sizes.npy", sizes)
        np.savetxt(tmp_path / "sizes.txt", sizes)
        found = []
        for given in (sizes.tolist(), "sizes.npy", "sizes.txt"):
            assert self.square(given, tmp_path, crossview, case_file).status == 0
            cells = pv.read(tmp_path / "out" / "surface.vtp").cell_data
            along = np.abs(cells["u"][:, 0]) > 0.5
            found.append(np.where(along, cells["H1"], cells["H2"]))
        centre = pv.read(tmp_path / "out" / "surface.vtp").cell_centers().points[:, 0]
        assert np.ptp(found[0] - 0.5 * centre) < 0.02
        assert np.allclose(found[0], found[1])
        assert np.allclose(found[0], found[2])

    @pytest.mark.parametrize(
        ("content", "said"),
        [
            (np.ones(80), "80 numbers for 81 vertices"),
            (np.ones((81, 3)), "81 x 3 numbers for 81 vertices"),
            (np.r_[np.ones(80), np.nan], "not positive and finite (.*vertex 80)"),
            (
                np.r_[0.0, -1.0, np.ones(79)],
                "2 sizes are not .*first at vertex 0)",
            ),
            (np.array(["a"] * 81), "not an array of numbers"),
            (np.array([None] * 81), "not an array of numbers"),
        ],
    )
    def test_a_wrong_map_is_refused(
        self, content: object, said: str, tmp_path: Path, crossview: Crossview, case_file: CaseFile
    ) -> None:
        np.save(tmp_path / "sizes.npy", np.asarray(content), allow_pickle=True)
        ran = self.square("sizes.npy", tmp_path, crossview, case_file)
        assert ran.status == 2
        assert ran.err.count("\n") == 1
        for part in said.split(".*"):
            assert part.rstrip("(") in ran.err
        assert not (tmp_path / "out").exists()

    @pytest.mark.parametrize(
        ("name", "content", "said"),
        [
            ("sizes.txt", None, "cannot read"),
            ("sizes.txt", b"one two", "not an array"),
            ("sizes.txt", b"", "0 numbers for 81"),
            ("sizes.npy", b"", "not an array"),
            ("sizes.npy", b"PK\x03\x04" + bytes(30), "not an array"),
            ("sizes.npy", b"\x93NUMPY\x01\x00", "not an array"),
            ("sizes.npy", b"\x93NUMPY\x01\x00\x10\x00{'descr': 'f8'}\n", "not an array"),
        ],
    )
    def test_a_file_that_is_none_is_refused(
        self,
        name: str,
        content: bytes | None,
        said: str,
        tmp_path: Path,
        crossview: Crossview,
        case_file: CaseFile,
    ) -> None:
        if content is not None:
            (tmp_path / name).write_bytes(content)
        ran = self.square(name, tmp_path, crossview, case_file)
        assert ran.status == 2
        assert said in ran.err

    def test_logarithms_are_linear_in_the_triangles_refined(self) -> None:
        surface = BUILTIN["square"](n=8)
        point = surface.closest_point(np.array([0.1, 0.07, 0.0]))
        refinement = refine_at(surface, [point], 3)
        sizes = np.exp(surface.vertices[:, :2] @ [[1.0, 0.0], [2.0, -1.0]])
        wanted = np.exp(refinement.surface.vertices[:, :2] @ [[1.0, 0.0], [2.0, -1.0]])
        assert np.allclose(refined_sizes(sizes, refinement), wanted)
        assert np.allclose(refined_sizes(sizes[:, 0], refinement), wanted[:, 0])

    def test_a_size_map_leads_the_sizes_between_singularities(self) -> None:
        options = replace(OPTIONS, refine=1)
        case = annulus("anisotropic", options=options)
        problem = Problem.from_case(case)
        wanted = np.exp(0.5 * problem.surface.vertices[:, 0])
        led = replace(options, sizes=tuple(float(size) for size in wanted))
        plain = run(Pipeline().solve(problem)).field
        field = run(Pipeline().solve(replace(problem, options=led))).field
        assert field.energy < 1e-10

        def likeness(found: CrossField) -> float:
            return float(np.corrcoef(found.H, found.surface.vertices[:, 0])[0, 1])

        assert likeness(field) > likeness(plain) + 0.1


class TestPipeline:
    def test_switching_methods_keeps_every_result(self) -> None:
        problem = Problem.from_case(annulus("isotropic"))
        pipeline = Pipeline()
        methods = ("isotropic", "aligned", "anisotropic")
        first = {m: run(pipeline.solve(replace(problem, method=m))) for m in methods}
        for method in reversed(methods):
            again = replace(problem, method=method)
            solution = run(pipeline.solve(again))
            assert solution.problem is again
            assert solution.field is first[method].field
        aligned, anisotropic = (first[m].integrated for m in ("aligned", "anisotropic"))
        assert aligned is not None
        assert anisotropic is not None
        assert aligned.aligned is anisotropic.aligned

    @pytest.mark.parametrize(
        "change",
        [
            {"valence": 2},
            {"options": replace(OPTIONS, tolerance_degrees=1.0)},
            {"options": replace(OPTIONS, turns=(1,))},
        ],
    )
    def test_no_result_outlives_its_problem(self, change: dict[str, Any]) -> None:
        problem = Problem.from_case(annulus("aligned"))
        pipeline = Pipeline()
        first = run(pipeline.solve(problem))
        if "valence" in change:
            a, b, *rest = problem.singularities
            swapped = (replace(a, valence=b.valence + 1), replace(b, valence=a.valence - 1), *rest)
            other = replace(problem, singularities=swapped)
        else:
            other = replace(problem, **change)
        second = run(pipeline.solve(other))
        assert second.field is not first.field
        assert second.refinement is first.refinement
        assert run(pipeline.solve(problem)).field is not first.field

    def test_a_size_map_that_changed_on_disk_is_solved_again(self, tmp_path: Path) -> None:
        name = str(tmp_path / "sizes.npy")
        options = replace(OPTIONS, sizes=name)
        problem = replace(Problem.from_case(annulus("anisotropic")), options=options)
        x = problem.surface.vertices[:, 0]
        pipeline = Pipeline()
        found = []
        for sizes in (np.exp(x), np.exp(x), np.exp(-x)):
            np.save(name, sizes)
            found.append(run(pipeline.solve(problem)).field)
        assert found[0] is found[1]
        assert found[1] is not found[2]

    def test_every_iteration_is_shown_and_the_last_can_be_kept(self) -> None:
        pipeline = Pipeline()
        steps: list[Progress] = []
        running = pipeline.solve(Problem.from_case(annulus("anisotropic", 37)))
        for step in running:
            steps.append(step)
            if isinstance(step, FieldStep):
                break
        running.close()
        last = steps[-1]
        assert isinstance(last, FieldStep)
        kept = pipeline.so_far(last)
        assert kept.field.energy == pytest.approx(last.energies[-1])
        told = report(kept)
        assert not told["converged"]
        assert told["verdict"] == "not found"
        assert "not converged" in summary(kept)
        fractions = [step.fraction for step in steps]
        assert fractions == sorted(fractions)

    def test_nothing_can_be_kept_of_nothing(self, anisotropic: Solution) -> None:
        integrated = anisotropic.integrated
        assert integrated is not None
        with pytest.raises(CrossviewError, match="nothing has been solved"):
            Pipeline().so_far(FieldStep("", 0.0, (), integrated))

    def test_wrong_turns_are_told(self) -> None:
        with pytest.raises(CrossviewError, match="2 turns are given for 1 holonomy conditions"):
            solved(annulus("aligned", options=replace(OPTIONS, turns=(0, 1))))
