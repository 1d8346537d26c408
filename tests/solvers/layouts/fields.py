"""Fields with layouts that the tests of separatrices, layouts and quads share."""

import itertools
from collections.abc import Callable, Iterable, Sequence
from functools import cache

import numpy as np
from numpy.typing import ArrayLike

from solvers.features.dihedral import sharp_edges
from solvers.features.edges import Features
from solvers.fields.aligned import IntegratedField
from solvers.fields.integrable import anisotropic_field
from solvers.fields.prepared import prepare
from solvers.layouts.gauge import joined_field
from solvers.layouts.layout import QuadLayout, quad_layout
from solvers.primitives import BUILTIN
from solvers.progress import run
from solvers.singularities.budget import Singularity
from solvers.surface.trisurface import TriSurface
from tests.solvers.suite import separated


def at_places(
    surface: TriSurface, places: Iterable[ArrayLike], valences: Sequence[int]
) -> list[Singularity]:
    return [Singularity(surface.closest_point(p), k) for p, k in zip(places, valences, strict=True)]


def integrated(
    surface: TriSurface,
    singularities: Sequence[Singularity] = (),
    features: Features | None = None,
) -> IntegratedField:
    """The aligned field on a refined surface, made integrable if it is not."""
    aligned = joined_field(prepare(surface, singularities, features=features))
    start = IntegratedField(aligned, aligned.start)
    return start if start.field.energy < 1e-3 else run(anisotropic_field(aligned))


def cube_corners() -> np.ndarray:
    return np.asarray(np.array(list(itertools.product((-1, 1), repeat=3))) / np.sqrt(3))


def cube_sphere() -> IntegratedField:
    surface = BUILTIN["sphere"](subdivisions=4)
    return integrated(surface, at_places(surface, cube_corners(), [3] * 8))


def disk_four() -> IntegratedField:
    surface = BUILTIN["disk"](edge_length=0.08)
    places = [[0.5, 0, 0], [0, 0.5, 0], [-0.5, 0, 0], [0, -0.5, 0]]
    return integrated(surface, at_places(surface, places, [3] * 4))


def ring_of_eight() -> IntegratedField:
    """An annulus whose singularities make no isotropic field."""
    surface = BUILTIN["annulus"](n=64)
    angle = np.radians(45 * np.arange(8) + [0, 5] * 4)
    radius = np.where(np.arange(8) % 2, 0.85, 0.6)
    places = np.stack([radius * np.cos(angle), radius * np.sin(angle), 0 * angle], axis=1)
    return integrated(surface, at_places(surface, places, [3, 5] * 4))


def winding_sphere() -> IntegratedField:
    """A sphere with eight valence 3 that do not lie on lines with each other."""
    surface = BUILTIN["sphere"](subdivisions=4)
    return integrated(surface, separated(surface, 5, [3] * 8, 0.7))


def cube_with_edges() -> IntegratedField:
    """A cube's own edges as features, its corners as singularities."""
    sphere = BUILTIN["cube_sphere"](n=8)
    flattened = sphere.vertices / np.abs(sphere.vertices).max(axis=1)[:, None]
    cube = TriSurface(flattened, sphere.faces)
    corners = np.flatnonzero((np.abs(flattened) > 0.999).all(axis=1))
    singularities = at_places(cube, flattened[corners], [3] * 8)
    return integrated(cube, singularities, Features(cube, sharp_edges(cube, 40)))


def plain(name: str, **parameters: float) -> Callable[[], IntegratedField]:
    return lambda: integrated(BUILTIN[name](**parameters))


FIELDS: dict[str, Callable[[], IntegratedField]] = {
    "cube sphere": cube_sphere,
    "disk with four": disk_four,
    "ring of eight": ring_of_eight,
    "winding sphere": winding_sphere,
    "cube with edges": cube_with_edges,
    "torus": plain("torus", n=36),
    "annulus": plain("annulus", n=48),
    "cylinder": plain("cylinder", n=32),
    "square": plain("square", n=10),
    "L": plain("l_shape", edge_length=0.15),
}


@cache
def layout_of(name: str) -> QuadLayout:
    return run(quad_layout(FIELDS[name]()))
