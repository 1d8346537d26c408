"""Surfaces with poor triangles: slivers, needles, spikes, few triangles."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from solvers.primitives import BUILTIN
from solvers.surface.trisurface import TriSurface


def grid(rows: int, columns: int, around: bool, along: bool) -> np.ndarray:
    """Triangles of a grid of vertices, closed around and along or not."""
    wide = columns if around else columns - 1
    i, j = np.divmod(np.arange((rows if along else rows - 1) * wide), wide)
    a, b = i * columns + j, i * columns + (j + 1) % columns
    c, d = (i + 1) % rows * columns + (j + 1) % columns, (i + 1) % rows * columns + j
    return np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])


def polar_annulus(around: int, across: int, inner: float = 0.4) -> TriSurface:
    """An annulus of a polar grid: triangles as long as the grid is uneven."""
    t = 2 * np.pi * np.arange(around) / around
    r = np.linspace(1, inner, across + 1)[:, None]
    x, y = r * np.cos(t), r * np.sin(t)
    vertices = np.stack([x, y, np.zeros_like(x)], axis=2).reshape(-1, 3)
    return TriSurface(vertices, grid(across + 1, around, True, False))


def polar_torus(around: int, across: int, minor: float) -> TriSurface:
    """A torus of a grid of uneven numbers: stretched triangles all over."""
    t = 2 * np.pi * np.arange(around) / around
    p = 2 * np.pi * np.arange(across)[:, None] / across
    r = 1 + minor * np.cos(p)
    x, y, z = np.broadcast_arrays(r * np.cos(t), r * np.sin(t), minor * np.sin(p))
    return TriSurface(
        np.stack([x, y, z], axis=2).reshape(-1, 3), grid(across, around, True, True)[:, ::-1]
    )


def spiked_sphere(spikes: int, height: float) -> TriSurface:
    """A sphere some of whose vertices are pulled out to needles."""
    ball = BUILTIN["sphere"](subdivisions=3)
    vertices = ball.vertices.copy()
    pulled = np.random.default_rng(spikes).choice(len(vertices), spikes, replace=False)
    vertices[pulled] *= height
    return TriSurface(vertices, ball.faces)


def crumpled_sphere(roughness: float) -> TriSurface:
    """A sphere whose vertices are moved at random, in and out and along it."""
    ball = BUILTIN["sphere"](subdivisions=3)
    noise = np.random.default_rng(7).normal(size=ball.vertices.shape)
    return TriSurface(ball.vertices + roughness * noise, ball.faces)


def box(x: float, y: float, z: float, n: int) -> TriSurface:
    """A cube with n cells to a side, stretched."""
    cube = BUILTIN["cube_sphere"](n=n)
    vertices = cube.vertices / np.abs(cube.vertices).max(axis=1, keepdims=True)
    return TriSurface(vertices * [x, y, z], cube.faces)


def needle(height: float) -> TriSurface:
    """A cone of 24 slivers to a side on a disk."""
    around, across = 24, 12
    t = 2 * np.pi * np.arange(around) / around
    r = np.linspace(1, 0, across, endpoint=False)[:, None]
    x, y, z = np.broadcast_arrays(r * np.cos(t), r * np.sin(t), height * (1 - r))
    vertices = np.concatenate([np.stack([x, y, z], axis=2).reshape(-1, 3), [[0, 0, height]]])
    last = around * (across - 1) + np.arange(around)
    tip = np.full(around, len(vertices) - 1)
    fan = np.stack([last, np.roll(last, -1), tip], axis=1)
    return TriSurface(vertices, np.concatenate([grid(across, around, True, False), fan]))


POOR: dict[str, Callable[[], TriSurface]] = {
    "polar annulus 600 x 5": lambda: polar_annulus(600, 5),
    "polar annulus 16 x 120": lambda: polar_annulus(16, 120),
    "polar annulus 12 x 200": lambda: polar_annulus(12, 200),
    "polar annulus 48 x 12, narrow": lambda: polar_annulus(48, 12, 0.05),
    "torus 400 x 8": lambda: polar_torus(400, 8, 0.4),
    "torus 12 x 120": lambda: polar_torus(12, 120, 0.4),
    "torus 64 x 12, thick": lambda: polar_torus(64, 12, 0.9),
    "sphere with a spike": lambda: spiked_sphere(1, 4),
    "sphere with 12 spikes": lambda: spiked_sphere(12, 2.5),
    "crumpled sphere": lambda: crumpled_sphere(0.03),
    "cube of 2 cells": lambda: box(1, 1, 1, 2),
    "cube of 4 cells": lambda: box(1, 1, 1, 4),
    "plank of 8 cells": lambda: box(10, 1, 0.1, 8),
    "cone, flat": lambda: needle(0.5),
    "cone, needle": lambda: needle(8),
}
"""Made by name."""
