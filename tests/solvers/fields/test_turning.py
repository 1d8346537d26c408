"""The turns of a field between the boundaries of an annulus, against what topology allows."""

import numpy as np
import pytest

from solvers.fields.aligned import AlignedField, IntegratedField, aligned_field
from solvers.fields.integrable import anisotropic_field
from solvers.fields.prepared import prepare
from solvers.fields.turning import holonomy_class, turns_across
from solvers.fields.verdict import judge
from solvers.maps.seamless import seamless_map
from solvers.primitives import annulus
from solvers.progress import run
from solvers.singularities.remedies import ChangeTurns
from solvers.singularities.theorems import ANNULUS_TURNS
from solvers.singularities.topology import existence
from solvers.surface.trisurface import TriSurface

STAIRS = [[], [1, 1, -1, -1], [1, -1, -1, 1], [-1, -1, 1, 1]]


def cornered(surface: TriSurface, *given: list[int], shift: int = 3) -> dict[int, int]:
    """Corners evenly around both boundaries."""
    found: dict[int, int] = {}
    for loop, indices in zip(surface.boundary_loops, given, strict=True):
        places = (shift + np.arange(len(indices)) * len(loop) // max(len(indices), 1)) % len(loop)
        found |= dict(zip(loop[places].tolist(), indices, strict=True))
    return found


def field_with(surface: TriSurface, corners: dict[int, int], turns: int) -> AlignedField:
    return aligned_field(prepare(surface, corners=corners), [turns])


@pytest.mark.parametrize("outer", STAIRS)
@pytest.mark.parametrize("inner", [[], [1, -1]])
def test_the_turns_nearest_to_the_isotropic_field_are_possible(
    outer: list[int], inner: list[int]
) -> None:
    """For its own have the mean zero."""
    surface = annulus(n=72)
    for shift in (0, 3, 7):
        corners = cornered(surface, outer, inner, shift=shift)
        if not outer and inner:
            assert existence(surface, [], corners).answer == "impossible"
            continue
        aligned = field_with(surface, corners, 0)
        turns = holonomy_class(aligned)
        assert existence(surface, [], corners, turns).answer == "possible"
        across = turns_across(IntegratedField(aligned, aligned.start).field)
        assert turns == (round(across),)
        assert holonomy_class(field_with(surface, corners, 2)) == (turns[0] + 2,)


def test_a_field_whose_turns_part_the_boundaries_is_impossible_and_mended() -> None:
    surface = annulus(n=72)
    corners = cornered(surface, [1, 1, -1, -1], [])
    for turns in (-1, 1):
        aligned = field_with(surface, corners, turns)
        solved = run(anisotropic_field(aligned))
        verdict = judge(solved.field, 0, turns=holonomy_class(aligned))
        assert verdict.theorem is ANNULUS_TURNS
        assert len(seamless_map(solved).inverted)
        change = verdict.remedies[0]
        assert isinstance(change, ChangeTurns)
        assert change.by == (-turns,)


def test_the_possible_turns_have_an_injective_map() -> None:
    surface = annulus(n=72)
    aligned = field_with(surface, cornered(surface, [1, 1, -1, -1], []), 0)
    solved = run(anisotropic_field(aligned))
    assert solved.field.energy < 1e-8
    assert not len(seamless_map(solved).inverted)
