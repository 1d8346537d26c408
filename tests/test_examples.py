"""Each script in examples runs, and comes to what theory says."""

import runpy
from collections.abc import Callable
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
import pytest

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"
Example = Callable[[str], Any]

DISCRETE = 0.01
"""Degrees: how far a defect on a polygon may be from that on a circle."""


@pytest.fixture
def example(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Example:
    """Runs a script by its name in a folder of its own; its variables by name."""
    monkeypatch.chdir(tmp_path)
    matplotlib.use("agg")
    return lambda name: runpy.run_path(str(EXAMPLES / f"{name}.py"))


def degrees(angles: Any) -> float:
    """The largest of some angles."""
    return float(np.degrees(np.abs(angles).max()))


def test_a_disk_with_four_has_five_patches(example: Example, tmp_path: Path) -> None:
    there = example("figure")
    assert there["layout"].patches == 5
    assert degrees(there["solution"].field.boundary_misalignment) < 1e-9
    for name in ("figure.png", "figure.pdf"):
        assert (tmp_path / name).stat().st_size > 10_000


def test_a_cube_on_a_sphere_has_eight_irregular_vertices(example: Example, tmp_path: Path) -> None:
    mesh = example("quad_mesh")["mesh"]
    assert mesh.irregular == {3: 8}
    assert len(mesh.vertices) - mesh.n_quads == 2  # Euler: four edges to a quad, two quads to each
    assert len(list(tmp_path.glob("sphere.*"))) == 3


def test_the_defect_of_an_annulus_is_a_quarter_of_the_angle(
    example: Example, tmp_path: Path
) -> None:
    there = example("parameter_study")
    assert np.abs(there["measured"] - there["theory"]).max() < DISCRETE
    assert (tmp_path / "defects.png").exists()


def test_a_marked_line_is_a_line_of_edges(example: Example) -> None:
    there = example("plate_with_features")
    assert degrees(there["solution"].field.feature_misalignment) < 1e-9
    line = there["mesh"].vertices[there["on_line"]]
    np.testing.assert_allclose(np.ptp(line[:, 1]), 1.0, atol=1e-12)


def test_natural_singularities_meet_the_budget_and_are_made_valid(example: Example) -> None:
    there = example("natural_and_valid")
    # four corners of +1 on a surface of Euler characteristic 0
    assert sum(4 - s.valence for s in there["natural"].singularities) == -4
    assert degrees(there["solution"].holonomy_defects) < 1e-6
    assert there["mesh"].irregular == {5: 4}


def test_two_sizes_close_what_one_size_misses(example: Example) -> None:
    there = example("anisotropic")
    np.testing.assert_allclose(there["misaligned"]["isotropic"], 15.0, atol=DISCRETE)
    assert there["misaligned"]["anisotropic"] < 1e-9
    assert there["field"].energy < 1e-10


def test_each_example_is_tested() -> None:
    text = Path(__file__).read_text(encoding="utf-8")
    for path in EXAMPLES.glob("*.py"):
        assert f'example("{path.stem}")' in text
