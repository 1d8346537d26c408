"""The worst quads of a mesh made better, by trying places for their vertices."""

from __future__ import annotations

import numpy as np

from solvers.quads.incidence import CornersAround
from solvers.quads.quadmesh import QuadMesh
from solvers.quads.sliding import Places, Sliding
from solvers.surface.triangulation import BoolArray, FloatArray, IntArray

POOR = 0.7
"""Scaled Jacobian below which quads are worked on. Chosen: angles of 45 degrees, about."""

ROUNDS = 40
"""How often vertices of poor quads try to move. Chosen."""

POWER = 4
"""Of 1 - quality, in the sum that is least. Chosen: the higher, the more the worst quad counts."""

PATIENCE = 8
"""Rounds in which nothing moves, after which no more are tried. Chosen: twice all of `RADII`."""

RADII = (0.5, 0.2, 0.08, 0.03)
"""How far, in mean lengths of the edges around; one after the other. Chosen."""

DIRECTIONS = 8
"""How many ways are tried, evenly all around. Chosen."""


def improve_worst(sliding: Sliding, places: Places, free: IntArray, floor: FloatArray) -> Places:
    """Return places with poor quads improved, and none fallen below its floor.

    Vertices of poor quads, no two of one quad at a time, move to where the sum of powers of
    1 - quality of the quads around each is least.

    Parameters
    ----------
    sliding : Sliding
        What holds the vertices.
    places : Places
        Where they are.
    free : (k,) int array
        Vertices that may move.
    floor : (q,) float array
        Scaled Jacobian that each quad keeps, or else what it has.
    """
    mesh = sliding.mesh
    may_move = np.zeros(mesh.n_vertices, dtype=bool)
    may_move[free] = True
    around = CornersAround(mesh.quads, mesh.n_vertices)
    quality = sliding.quality(places, mesh.quads)
    idle = 0
    for k in range(ROUNDS):
        wanted = np.zeros(mesh.n_vertices, dtype=bool)
        wanted[mesh.quads[quality < POOR]] = True
        ids = np.flatnonzero(_independent(mesh, wanted & may_move, k))
        if len(ids) == 0 or idle == PATIENCE:
            break
        radius, least = RADII[k % len(RADII)], np.minimum(floor, quality)
        tried = _tried(sliding, places, ids, around, radius, least)
        idle = idle + 1 if (tried.vertices == places.vertices).all() else 0
        places = tried
        touched = around.pairs(ids)[1] // 4
        quality[touched] = sliding.quality(places, mesh.quads[touched])
    return places


def _independent(mesh: QuadMesh, wanted: BoolArray, round_: int) -> BoolArray:
    """Return some of the wanted vertices (n,), no two of one quad; others in other rounds."""
    n = mesh.n_vertices
    priority = np.where(wanted, np.random.default_rng(round_).permutation(n), n)
    least = np.full(n, n)
    np.minimum.at(least, mesh.quads, priority[mesh.quads].min(axis=1)[:, None])
    return np.asarray(wanted & (least == priority))


def _tried(
    sliding: Sliding,
    places: Places,
    ids: IntArray,
    around: CornersAround,
    radius: float,
    least: FloatArray,
) -> Places:
    """Return the places after each of the vertices took the best of a ring of places around it.

    None after which a quad is worse than its `least`.
    """
    quads = sliding.mesh.quads
    at, corner = around.pairs(ids)
    quad = corner // 4
    ring = places.vertices[quads[quad]]
    edges = np.linalg.norm(np.roll(ring, -1, axis=1) - ring, axis=2).mean(axis=1)
    size = radius * np.bincount(at, edges) / np.bincount(at)
    u, v = sliding.mesh.surface.face_frames
    angle = 2 * np.pi * np.arange(DIRECTIONS) / DIRECTIONS
    face = places.faces[ids]
    way = np.cos(angle)[:, None, None] * u[face] + np.sin(angle)[:, None, None] * v[face]
    targets = (
        places.vertices[ids] + np.concatenate([np.zeros((1, len(ids), 3)), way]) * size[:, None]
    )
    tries = DIRECTIONS + 1
    who = np.tile(ids, tries)
    made = sliding.moved(places, who, targets.reshape(-1, 3))
    # Number the tried places after all vertices, and look at each quad with one corner replaced.
    everything = Places(
        np.concatenate([places.vertices, made.vertices]),
        np.concatenate([places.faces, made.faces]),
        np.concatenate([places.weights, made.weights]),
        np.concatenate([places.s, made.s]),
    )
    number = sliding.mesh.n_vertices + np.arange(tries * len(ids)).reshape(tries, -1)
    corners = quads[quad]
    own = corners == ids[at][:, None]
    quality = sliding.quality(everything, np.where(own, number[:, at][:, :, None], corners))
    starts = np.flatnonzero(np.r_[True, np.diff(at) > 0])
    badness = np.add.reduceat((1 - quality) ** POWER, starts, axis=1)
    spoilt = np.logical_or.reduceat(quality < least[quad], starts, axis=1)
    spoilt[0] = False
    best = np.argmin(np.where(spoilt, np.inf, badness), axis=0)
    return places.put(ids, made.at(best * len(ids) + np.arange(len(ids))))
