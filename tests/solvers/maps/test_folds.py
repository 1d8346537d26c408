"""Fields with E = 0 whose map is folded, and others in their place."""

from collections.abc import Sequence

import numpy as np
import pytest

from solvers.fields.aligned import AlignedField, IntegratedField, aligned_field
from solvers.fields.integrable import anisotropic_field
from solvers.fields.prepared import prepare
from solvers.layouts.gauge import joined_field
from solvers.maps.folds import MappedField, neighbouring_turns, unfolded
from solvers.primitives import BUILTIN
from solvers.progress import Progress, run
from solvers.singularities.budget import Singularity
from solvers.surface.trisurface import TriSurface
from tests.solvers.suite import SURFACES, at_vertices, random_configuration

TORUS_PLACES = [
    [-0.35, -0.53, -0.23],
    [0.96, -0.65, -0.4],
    [0.42, -1.36, 0.04],
    [-0.98, -0.36, -0.43],
]
"""Two valences 3, two 5."""


def test_without_conditions_there_are_no_other_turns() -> None:
    sphere = BUILTIN["sphere"](subdivisions=2)
    cube = [[x, y, z] for x in (-0.6, 0.6) for y in (-0.6, 0.6) for z in (-0.6, 0.6)]
    assert neighbouring_turns(start(sphere, cube, [3] * 8)) == []


def start(
    surface: TriSurface, places: Sequence[Sequence[float]], valences: Sequence[int]
) -> AlignedField:
    placed = [
        Singularity(surface.closest_point(place), valence)
        for place, valence in zip(places, valences, strict=True)
    ]
    return joined_field(prepare(surface, placed))


def require_perfect(found: MappedField) -> None:
    """Integrable, aligned, upright and winding once around every vertex."""
    field = found.integrated.field
    assert field.energy < 1e-10
    assert np.abs(field.boundary_misalignment).max(initial=0) < 1e-9
    assert np.abs(field.defects).max() < 1e-9
    assert (found.map.inverted.tolist(), found.map.wrong_windings.tolist()) == ([], [])


def test_a_torus_folded_by_the_nearest_turns_is_upright_by_others() -> None:
    surface = BUILTIN["torus"](minor=0.433, n=48)
    aligned = start(surface, TORUS_PLACES, [3, 3, 5, 5])
    first = MappedField.of(run(anisotropic_field(aligned)))
    assert first.integrated.field.energy < 1e-10  # E does not tell
    assert first.folded
    found = run(unfolded(first))
    require_perfect(found)
    assert found.integrated.aligned.turns != first.integrated.aligned.turns
    assert found.integrated.field.max_log_aspect < first.integrated.field.max_log_aspect


@pytest.mark.parametrize("seed", [8, 3])
def test_two_handles_are_upright_by_other_turns_though_nothing_is_stretched_much(seed: int) -> None:
    """By the nearest other turns, and by the fifth."""
    surface = BUILTIN["genus"](handles=2, subdivisions=1)
    places = np.random.default_rng(seed).choice(surface.n_vertices, 2, replace=False)
    aligned = joined_field(prepare(surface, at_vertices(surface, places.tolist(), [8, 8])))
    first = MappedField.of(run(anisotropic_field(aligned)))
    assert first.integrated.field.max_log_aspect < 2  # a factor of less than 8
    assert first.faults
    found = run(unfolded(first))
    require_perfect(found)
    assert found.integrated.aligned.turns != first.integrated.aligned.turns


@pytest.mark.parametrize(
    ("inner", "n", "radii", "degrees"),
    [(0.476, 64, (0.71, 0.66), 122), (0.317, 48, (0.7, 0.88), 163)],
)
def test_an_annulus_is_upright_on_another_way_by_the_same_turns(
    inner: float, n: int, radii: tuple[float, float], degrees: float
) -> None:
    """As it has to be where turns are asked for."""
    surface = BUILTIN["annulus"](inner=inner, n=n)
    x, y = radii[1] * np.cos(np.radians(degrees)), radii[1] * np.sin(np.radians(degrees))
    first = MappedField.of(
        run(anisotropic_field(start(surface, [[radii[0], 0, 0], [x, y, 0]], [3, 5])))
    )
    assert first.integrated.field.energy < 1e-10
    assert first.folded
    found = run(unfolded(first, keep_turns=True))
    require_perfect(found)
    assert found.integrated.aligned.turns == first.integrated.aligned.turns


def test_what_is_not_folded_is_not_solved_again() -> None:
    surface = SURFACES["annulus"]()
    aligned = aligned_field(prepare(surface, random_configuration(surface, seed=4), refine=0))
    first = MappedField.of(run(anisotropic_field(aligned)))
    assert not first.folded
    steps: list[Progress] = []
    assert run(unfolded(first), steps.append) is first
    assert steps == []


@pytest.mark.parametrize("name", ["annulus", "plate", "torus", "double_torus"])
def test_neighbouring_turns_come_in_the_order_of_their_energy(name: str) -> None:
    """E of an aligned field is the norm of its harmonic correction."""
    surface = SURFACES[name]()
    prepared = prepare(surface, random_configuration(surface, seed=4), refine=0)
    nearest = aligned_field(prepared)
    m = len(nearest.turns)
    turns = neighbouring_turns(nearest)
    assert len(set(turns)) == len(turns) == 2 * m + 4 * m * (m - 1) // 2
    assert nearest.turns not in turns
    energies = []
    for each in turns[:6]:
        other = aligned_field(prepared, each, like=nearest.isotropic)
        energies.append(IntegratedField(other, other.start).field.energy)
    assert energies == sorted(energies)
