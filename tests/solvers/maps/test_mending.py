"""Triangles that come out inverted: few are repaired, many are left as they are.

The fields are noise on top of good ones: the more of it, the more triangles come out inverted.
"""

from functools import cache

import numpy as np
import pytest

from solvers.fields.aligned import AlignedField, IntegratedField, aligned_field
from solvers.fields.prepared import prepare
from solvers.maps.seamless import SeamlessFit
from tests.solvers.suite import SURFACES, random_configuration

MANY = 0.05


@cache
def quiet(name: str) -> AlignedField:
    surface = SURFACES[name]()
    return aligned_field(prepare(surface, random_configuration(surface, 1, pairs=0), refine=0))


def fitted(name: str, seed: int, noise: float) -> tuple[SeamlessFit, float]:
    """The map of a noisy field, and its share of inverted triangles."""
    aligned = quiet(name)
    rng = np.random.default_rng(seed)
    x = aligned.start + noise * rng.normal(size=aligned.start.shape)
    fit = SeamlessFit(IntegratedField(aligned, x))
    return fit, len(fit.map.inverted) / len(fit.map.images)


@pytest.mark.parametrize("noise", [0.3, 0.5, 0.55, 0.6, 0.8])
@pytest.mark.parametrize(
    ("name", "seed"), [("square", 2), ("square", 3), ("disk", 3), ("torus", 3)]
)
def test_noise_is_repaired_or_has_turned_many_over(name: str, seed: int, noise: float) -> None:
    fit, inverted = fitted(name, seed, noise)
    assert fit.map.upright or inverted > MANY
    assert fit.map.upright or noise > 0.3
