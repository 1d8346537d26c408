"""The anisotropic solver: E to round-off where one scale cannot be aligned."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from solvers.errors import CrossviewError
from solvers.fields.aligned import AlignedField, IntegratedField, aligned_field
from solvers.fields.alternating import alternate
from solvers.fields.anisotropic import MinimumNormNewton
from solvers.fields.crossfield import CrossField
from solvers.fields.integrable import FieldStep, alternating_field, anisotropic_field, by_stages
from solvers.fields.prepared import prepare
from solvers.fields.verdict import judge
from solvers.maps.seamless import seamless_map
from solvers.primitives import BUILTIN
from solvers.progress import Progress, run
from solvers.singularities.budget import Singularity, default_corners
from solvers.surface.refinement import refine_at
from solvers.surface.triangulation import QUARTER, wrap
from solvers.surface.trisurface import TriSurface
from solvers.validity.attempts import make_valid
from tests.solvers.suite import SURFACES, at_vertices, random_configuration, separated

DISTORTED = ["annulus", "plate", "cylinder", "torus_with_hole", "double_torus", "slivers"]


def aligned(surface: TriSurface, configuration: list[Singularity]) -> AlignedField:
    return aligned_field(prepare(surface, configuration, refine=0))


@pytest.mark.parametrize("name", DISTORTED)
def test_the_aligned_field_is_aligned_everywhere(name: str) -> None:
    surface = SURFACES[name]()
    start = aligned(surface, random_configuration(surface, seed=4))
    field = IntegratedField(start, start.start).field
    assert np.abs(start.isotropic.defects).max() > 0.01
    assert np.abs(field.defects).max() < 1e-9
    assert np.abs(field.boundary_misalignment).max(initial=0) < 1e-9
    assert field.max_closing_error < 1e-9


def test_the_energy_of_the_aligned_field_is_that_of_its_harmonic_correction() -> None:
    """On an annulus E^2 = r^2 / <eta, eta>, with <eta, eta> = log(outer / inner) / (2 pi)."""
    surface = BUILTIN["annulus"](inner=0.4, n=96)
    start = aligned(surface, separated(surface, 1, [3, 5] * 4, 0.15))
    defect = start.isotropic.defects[0]
    expected = abs(defect) / np.sqrt(np.log(1 / 0.4) / (2 * np.pi))
    field = IntegratedField(start, start.start).field
    assert field.energy == pytest.approx(expected, rel=2e-3)


def test_other_turns_are_other_aligned_fields() -> None:
    surface = SURFACES["annulus"]()
    prepared = prepare(surface, random_configuration(surface, seed=4), refine=0)
    energies = []
    for turns in ([-1], [0], [1]):
        start = aligned_field(prepared, turns)
        field = IntegratedField(start, start.start).field
        assert np.abs(field.boundary_misalignment).max() < 1e-9
        energies.append(field.energy)
    assert energies[1] < min(energies[0], energies[2])
    with pytest.raises(CrossviewError, match="2 turns are given for 1 holonomy conditions"):
        aligned_field(prepared, [0, 1])


@pytest.mark.parametrize("name", ["annulus", "torus_with_hole", "double_torus", "disk"])
def test_the_jacobian_is_the_derivative_of_the_residual(name: str) -> None:
    surface = SURFACES[name]()
    problem = aligned(surface, random_configuration(surface, seed=1)).integrability
    rng = np.random.default_rng(0)
    x = 0.2 * rng.normal(size=problem.assembly.n)
    direction = rng.normal(size=problem.assembly.n)
    step = 1e-5
    ahead, behind = (problem.residual(x + sign * step * direction).values for sign in (1, -1))
    by_jacobian = np.einsum(
        "mri,mi->mr", problem.residual(x).jacobian, problem.assembly.gathered(direction)
    )
    assert np.abs((ahead - behind) / (2 * step) - by_jacobian).max() < 1e-7


@pytest.mark.parametrize("seed", range(20))
def test_random_annuli_converge_from_equal_sizes_in_few_steps(seed: int) -> None:
    surface = BUILTIN["annulus"](inner=0.4, n=64)
    newton = MinimumNormNewton(
        aligned(surface, separated(surface, seed, [3, 5] * 4, 0.2)).integrability
    )
    end = run(newton.solve(np.zeros(newton.integrability.assembly.n)))
    assert end.history[-1] < 1e-10
    assert len(end.history) - 1 <= 15


@pytest.mark.parametrize(
    ("make", "valences", "gap"),
    [
        (lambda: BUILTIN["plate_with_holes"](holes=2, edge_length=0.15), [5] * 4, 0.4),
        (lambda: BUILTIN["plate_with_holes"](holes=3, edge_length=0.15), [5] * 6 + [6], 0.4),
        (lambda: BUILTIN["annulus"](n=64), [6, 3, 3], 0.3),
        (lambda: BUILTIN["annulus"](n=64), [8, 3, 3, 3, 3], 0.25),
        (lambda: BUILTIN["torus"](n=48), [3, 3, 5, 5], 0.4),
        (lambda: BUILTIN["sphere"](subdivisions=4), [3] * 8, 0.4),
    ],
)
def test_other_surfaces_and_valences_converge(
    make: Callable[[], TriSurface], valences: list[int], gap: float
) -> None:
    surface = make()
    missing = (
        4 * surface.euler_characteristic
        - sum(default_corners(surface).values())
        - sum(4 - v for v in valences)
    )
    valences = valences + [3 if missing > 0 else 5] * abs(missing)
    start = aligned(surface, separated(surface, 0, valences, gap))
    newton = MinimumNormNewton(start.integrability)
    end = run(newton.solve(np.zeros(start.integrability.assembly.n)))
    assert end.history[-1] < 1e-10
    assert len(end.history) - 1 <= 15


def test_the_last_newton_steps_are_quadratic() -> None:
    surface = BUILTIN["annulus"](inner=0.4, n=96)
    start = aligned(surface, separated(surface, 3, [3, 5] * 4, 0.2))
    newton = MinimumNormNewton(start.integrability)
    energies = np.array(run(newton.solve(start.start)).history)
    falling = energies[(energies < 0.1) & (energies > 1e-7)]
    following = energies[1:][(energies[:-1] < 0.1) & (energies[:-1] > 1e-7)]
    assert len(falling) >= 1
    assert (following < 10 * falling**2).all()


def test_a_square_keeps_its_constant_field() -> None:
    surface = BUILTIN["square"](n=16)
    field = run(anisotropic_field(aligned(surface, []))).field
    assert field.energy < 1e-10
    assert max(np.abs(field.H1).max(), np.abs(field.H2).max()) < 1e-8


@pytest.mark.parametrize("name", ["sphere", "disk", "l_shape"])
def test_a_valid_isotropic_field_is_left_alone(name: str) -> None:
    surface = SURFACES[name]()
    start = aligned(surface, random_configuration(surface, seed=1))
    field = run(anisotropic_field(start)).field
    assert field.convergence.energies[0] < 1e-9
    assert np.abs(field.half_log_aspect).max() == 0
    assert np.abs(field.H - start.isotropic.H).max() < 1e-12


def test_a_configuration_made_valid_keeps_its_square_quads() -> None:
    surface = SURFACES["annulus"]()
    moved = run(make_valid(surface, separated(surface, 3, [3, 5] * 4, 0.15)))
    refinement = refine_at(surface, [s.point for s in moved.singularities])
    valences = [s.valence for s in moved.singularities]
    fine = refinement.surface
    field = run(
        anisotropic_field(aligned(fine, at_vertices(fine, refinement.vertices.tolist(), valences)))
    ).field
    assert field.energy < 1e-10
    assert field.max_log_aspect < 0.01


def solved(name: str, seed: int = 4) -> tuple[AlignedField, CrossField]:
    surface = SURFACES[name]()
    start = aligned(surface, random_configuration(surface, seed))
    return start, run(anisotropic_field(start)).field


@pytest.mark.parametrize("name", DISTORTED)
def test_the_anisotropic_field_is_aligned_integrable_and_keeps_its_indices(name: str) -> None:
    _, field = solved(name)
    assert field.convergence.converged
    assert field.energy < 1e-10
    assert np.abs(field.boundary_misalignment).max(initial=0) < 1e-9
    assert field.max_closing_error < 1e-9
    assert np.abs(field.defects).max() < 1e-9


def test_smoothing_lowers_the_regulariser_and_stays_integrable() -> None:
    surface = SURFACES["annulus"]()
    start = aligned(surface, random_configuration(surface, seed=4))
    rough = run(anisotropic_field(start, smooth=False)).field
    smooth = run(anisotropic_field(start)).field

    def regulariser(field: CrossField) -> float:
        t = surface.triangulation
        return sum(
            float(t.areas @ (t.gradients(values) ** 2).sum(axis=1))
            for values in (field.H1, field.H2)
        )

    assert regulariser(smooth) < 0.95 * regulariser(rough)
    assert smooth.energy < 1e-10


def test_sizes_follow_the_map_where_nothing_hinders() -> None:
    """On a square any sizes f(x) along x and g(y) along y are integrable (paper, exSquare2)."""
    surface = BUILTIN["square"](n=16)
    x, y, _ = surface.vertices.T
    sizes = np.exp(np.stack([0.5 * np.sin(3 * x), 0.7 * y], axis=1))
    field = run(anisotropic_field(aligned(surface, []), sizes)).field
    along_x = np.abs(field.u[:, 0]) > 0.5
    found = np.where(along_x[:, None], field.H1, field.H2)
    other = np.where(along_x[:, None], field.H2, field.H1)
    wanted = np.log(sizes)[surface.faces]
    first, second = found - wanted[:, :, 0], other - wanted[:, :, 1]
    assert field.energy < 1e-10
    assert max(np.ptp(first), np.ptp(second)) < 0.02


@pytest.mark.parametrize(
    ("sizes", "message"),
    [
        (np.ones(7), "7 numbers for 289 vertices"),
        (np.ones((289, 3)), "289 x 3 numbers for 289 vertices"),
        (0.1, "a single number for 289 vertices"),
        (["small"] * 289, "the size map must be numbers"),
        (np.ones(289, dtype=bool), "the size map must be numbers, not True and False"),
        (np.full(289, np.nan), r"289 sizes are not positive and finite \(sizes, the first .* 0\)"),
        (np.r_[1.0, 0.0, np.ones(287)], r"a size is not positive and finite \(sizes, vertex 1\)"),
    ],
)
def test_bad_size_maps_are_refused(sizes: NDArray[np.float64], message: str) -> None:
    surface = BUILTIN["square"](n=16)
    assert surface.n_vertices == 289
    with pytest.raises(CrossviewError, match=message):
        run(anisotropic_field(aligned(surface, []), sizes))


def test_the_papers_alternation_falls_steadily_and_stalls_far_from_validity() -> None:
    surface = BUILTIN["annulus"](inner=0.4, n=64)
    near = alternate(aligned(surface, separated(surface, 1, [3, 5] * 4, 0.2)), weight=1e-3)
    history = np.array(run(near).history)
    assert (np.diff(history) <= 0).all()
    assert history[-1] < 0.1 * history[0]


def test_the_history_is_what_the_steps_have_shown() -> None:
    start = aligned(SURFACES["annulus"](), random_configuration(SURFACES["annulus"](), seed=4))
    for solver in (anisotropic_field(start), alternating_field(start)):
        shown: list[Progress] = []
        end = run(solver, shown.append)
        history = end.field.convergence.energies
        last = [step for step in shown if isinstance(step, FieldStep)][-1]
        assert last.energies == history[: len(last.energies)]
        assert history[-1] == pytest.approx(end.field.energy, abs=1e-12)
        assert len(history) <= len(shown) + 2


@pytest.mark.parametrize("name", ["annulus", "plate", "double_torus"])
@pytest.mark.parametrize("stages", [2, 4])
def test_the_homotopy_reaches_the_aligned_field_by_stages(name: str, stages: int) -> None:
    surface = SURFACES[name]()
    start = aligned(surface, random_configuration(surface, seed=4))
    assert np.abs(start.isotropic.defects).max() > np.radians(5)
    partly = start.partly(0.5)
    assert partly.assembly.n == start.integrability.assembly.n
    halfway = partly.residual(start.start).energy
    assert halfway == pytest.approx(start.integrability.residual(start.start).energy / 2)
    end = run(by_stages(start, MinimumNormNewton(start.integrability), stages))
    assert end.converged
    assert end.history[0] < start.integrability.residual(start.start).energy


def test_each_step_can_be_shown_as_a_field() -> None:
    surface = SURFACES["annulus"]()
    start = aligned(surface, random_configuration(surface, seed=4))
    shown: list[FieldStep] = []
    for solver in (anisotropic_field(start), alternating_field(start)):
        steps: list[Progress] = []
        run(solver, steps.append)
        shown.append(next(s for s in steps if isinstance(s, FieldStep)))
    for step in shown:
        field = step.so_far.field
        assert step.energies[0] == pytest.approx(IntegratedField(start, start.start).field.energy)
        assert field.energy == pytest.approx(step.energies[-1], rel=1e-6)
        assert not field.convergence.converged


@pytest.mark.parametrize("name", ["annulus", "sphere", "double_torus"])
def test_the_seamless_map_closes_without_flips(name: str) -> None:
    surface = SURFACES[name]()
    valences = [s.valence for s in random_configuration(surface, 0, pairs=1)]
    start = aligned(surface, separated(surface, 2, valences, 0.25))
    mapped = seamless_map(run(anisotropic_field(start)))
    assert len(mapped.inverted) == 0
    assert mapped.distance < 0.05
    assert np.abs(mapped.images.sum(axis=1)).max() < 1e-9
    t, i = surface.triangulation, start.integrability
    h = t.edge_halfedges[t.twin[t.edge_halfedges] >= 0]
    complex_images = mapped.images[..., 0] + 1j * mapped.images[..., 1]
    one, other = complex_images.reshape(-1)[h], complex_images.reshape(-1)[t.twin[h]]
    assert np.abs(other + 1j ** i.period_jumps[h] * one).max() < 1e-9


def test_the_map_is_not_turned_over_where_sizes_differ_a_thousandfold() -> None:
    """Eight valence 3 around one end of a long ellipsoid: sizes grow as exp towards the other."""
    surface = BUILTIN["ellipsoid"](x=5, y=1, z=1, subdivisions=4)
    angles = np.arange(8) * np.pi / 4
    places = np.stack([0 * angles + 4, 0.6 * np.cos(angles), 0.6 * np.sin(angles)], axis=1)
    vertices = [int(np.linalg.norm(surface.vertices - p, axis=1).argmin()) for p in places]
    start = aligned(surface, at_vertices(surface, vertices, [3] * 8))
    assert np.ptp(start.isotropic.H) > np.log(1000)
    assert len(seamless_map(IntegratedField(start, start.start)).inverted) == 0


def test_triangles_turned_over_at_singularities_are_mended() -> None:
    """A valence 5 inside a triangle: 450 degrees of the map for the three triangles around it."""
    surface = BUILTIN["annulus"](n=48)
    turn = np.radians(12) * np.repeat([0, 1], 4) + np.arange(8) * np.pi / 2
    radius = np.repeat([0.8, 0.6], 4)
    x, y = radius * np.cos(turn), radius * np.sin(turn)
    places = [surface.closest_point(p) for p in np.stack([x, y, 0 * x], axis=1)]
    refined = refine_at(surface, places, levels=0)
    start = aligned(
        refined.surface, at_vertices(refined.surface, refined.vertices.tolist(), [3] * 4 + [5] * 4)
    )
    mapped = seamless_map(run(anisotropic_field(start)))
    assert len(mapped.inverted) == 0
    assert np.abs(mapped.images.sum(axis=1)).max() < 1e-9


def test_the_impossible_torus_is_called_impossible() -> None:
    surface = BUILTIN["torus"](n=36)
    start = aligned(surface, at_vertices(surface, [100, 500], [3, 5]))
    field = run(anisotropic_field(start)).field
    verdict = judge(field, 0)
    assert verdict.status == "impossible"
    assert "torus" in verdict.reason


def test_verdicts_name_their_reason() -> None:
    start, field = solved("annulus")
    assert judge(field, 0).status == "valid"
    assert "3 triangles are inverted" in judge(field, 3).reason
    unaligned = judge(start.isotropic)
    assert unaligned.status == "not found"
    assert f"{np.degrees(np.abs(start.isotropic.defects[0])):.3g} degrees" in unaligned.reason
    merely_aligned = IntegratedField(start, start.start).field
    assert "not integrable" in judge(merely_aligned).reason
    for residual in (1e-9, np.nan):
        unsolved = judge(replace(field, residual=residual), 0)
        assert unsolved.status == "not found"
        assert "residual" in unsolved.reason


@pytest.mark.parametrize("name", ["annulus", "torus_with_hole"])
def test_the_solution_does_not_depend_on_the_frames(name: str) -> None:
    """Faces renumbered and their corners turned: the same sizes and crosses."""
    surface = SURFACES[name]()
    configuration = random_configuration(surface, seed=4)
    vertices = [
        surface.faces[s.point.face, int(np.argmax(s.point.barycentric))] for s in configuration
    ]
    rng = np.random.default_rng(0)
    rows, roll = rng.permutation(surface.n_faces), rng.integers(3, size=surface.n_faces)
    turned = np.take_along_axis(surface.faces[rows], (np.arange(3) + roll[:, None]) % 3, axis=1)
    other = TriSurface(surface.vertices, turned)
    again = at_vertices(other, vertices, [s.valence for s in configuration])
    first = run(anisotropic_field(aligned(surface, configuration))).field
    second = run(anisotropic_field(aligned(other, again))).field
    assert np.abs(first.H - second.H).max() < 1e-6
    across = np.einsum("ij,ij->i", first.v[rows], second.u)
    along = np.einsum("ij,ij->i", first.u[rows], second.u)
    assert np.abs(wrap(np.arctan2(across, along), QUARTER)).max() < 1e-6
