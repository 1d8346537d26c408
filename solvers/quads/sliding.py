"""Moving the vertices of a quad mesh on their surface and along their rails."""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass, replace

import numpy as np

from solvers.quads.corners import TangentPlanes, unit
from solvers.quads.projection import Projection
from solvers.quads.quadmesh import QuadMesh
from solvers.quads.rails import Rail
from solvers.surface.triangulation import BoolArray, FloatArray, IntArray

REACH = 0.4
"""Share of the gap to its neighbour on the rail that a vertex may cross in one step.

Less than a half, so that two neighbours never pass each other.
"""

SAME_PLACE = 1e-9
"""Distance, in diagonals of the surface, that counts as none. Chosen, above rounding."""


@dataclass(frozen=True, eq=False)
class Places:
    """Where vertices are.

    Parameters
    ----------
    vertices : (n, 3) float array
        Coordinates.
    faces : (n,) int array
        Triangle each lies in.
    weights : (n, 3) float array
        Its weights there.
    s : (n,) float array
        Length along its rail, if it has one.
    """

    vertices: FloatArray
    faces: IntArray
    weights: FloatArray
    s: FloatArray

    def at(self, ids: IntArray) -> Places:
        """Return the places of some vertices."""
        return Places(self.vertices[ids], self.faces[ids], self.weights[ids], self.s[ids])

    def put(self, ids: IntArray, other: Places) -> Places:
        """Return these places with those of some vertices replaced."""
        made = Places(self.vertices.copy(), self.faces.copy(), self.weights.copy(), self.s.copy())
        made.vertices[ids], made.faces[ids] = other.vertices, other.faces
        made.weights[ids], made.s[ids] = other.weights, other.s
        return made


class Sliding:
    """What holds the vertices of a quad mesh.

    Parameters
    ----------
    mesh : QuadMesh
        The mesh.
    rails : list of Rail
        Chains of edges of its surface.
    rail : (n,) int array
        The rail each vertex is on, or -1.
    slim : float
        Longest side of a quad, in its shortest, beyond which it counts as poorer.

    Attributes
    ----------
    near : float
        Distance that counts as none.
    """

    def __init__(
        self, mesh: QuadMesh, rails: list[Rail], rail: IntArray, slim: float = np.inf
    ) -> None:
        self.mesh, self.rails, self.rail, self._slim = mesh, rails, rail, slim
        self.near = SAME_PLACE * mesh.surface.diagonal
        self._projection = Projection(mesh.surface)
        self._planes = TangentPlanes(mesh.surface)

    def start(self) -> Places:
        """Return where the vertices of the mesh are."""
        mesh = self.mesh
        s = np.zeros(mesh.n_vertices)
        for i, rail in enumerate(self.rails):
            on = np.flatnonzero(self.rail == i)
            s[on] = rail.nearest(mesh.vertices[on])
        return Places(mesh.vertices, mesh.faces, mesh.barycentric, s)

    def part(self, some: BoolArray) -> Sliding:
        """Return what holds the vertices of some of the quads (q,); those of others stay."""
        quads, fixed = self.mesh.quads, self.mesh.fixed.copy()
        fixed[quads[~some]] = True
        other = copy(self)
        other.mesh = replace(self.mesh, quads=quads[some], fixed=fixed)
        return other

    def quality(self, places: Places, quads: IntArray) -> FloatArray:
        """Return the scaled Jacobians of quads (..., 4), given by vertices; less of slim ones."""
        found = self._planes.quality(places.faces, places.weights, places.vertices, quads)
        if np.isinf(self._slim):
            return found
        corners = places.vertices[quads]
        length = np.linalg.norm(np.roll(corners, -1, axis=-2) - corners, axis=-1)
        longest = np.maximum(length.max(axis=-1), 1e-300)
        return np.asarray(np.minimum(found, self._slim * length.min(axis=-1) / longest))

    def normals(self, places: Places, quads: IntArray) -> FloatArray:
        """Return the surface's normals (..., 4, 3) at the corners of quads (..., 4)."""
        return self._planes.corner_normals(places.faces, places.weights, places.vertices, quads)

    def snapped(self, places: Places) -> tuple[Places, IntArray]:
        """Put the nearest vertex of a rail on each of its corners that has none.

        Returns
        -------
        places : Places
            With vertices on the corners.
        held : (k,) int array
            Those vertices.
        """
        held: list[int] = []
        s, vertices = places.s.copy(), places.vertices
        taken = vertices[self.mesh.fixed]
        for i, rail in enumerate(self.rails):
            on = np.flatnonzero(self.rail == i)
            for corner in rail.corners if len(on) else ():
                place = rail.positions(np.array([corner]))
                if (np.linalg.norm(taken - place, axis=1) < self.near).any():
                    continue
                gap = rail.apart(s[on], corner)
                k = on[np.argmin(np.abs(gap))]
                if not self.mesh.fixed[k] and k not in held:
                    s[k] = corner
                    held.append(int(k))
                    taken = np.concatenate([taken, place])
        ids = np.array(held, dtype=np.int64)
        return places.put(ids, self._on_rails(ids, s[ids])), ids

    def moved(self, places: Places, ids: IntArray, targets: FloatArray) -> Places:
        """Return where vertices come to when they are drawn towards targets.

        Parameters
        ----------
        places : Places
            Of all vertices.
        ids : (k,) int array
            Vertices, any number of times.
        targets : (k, 3) float array
            Where each would go if nothing held it.
        """
        faces, weights = places.faces[ids].copy(), places.weights[ids].copy()
        vertices, s = places.vertices[ids].copy(), places.s[ids].copy()
        railed = self.rail[ids] >= 0
        loose = np.flatnonzero(~railed)
        faces[loose], weights[loose] = self._projection.slide(faces[loose], targets[loose])
        vertices[loose] = self._projection.positions(faces[loose], weights[loose])
        made = Places(vertices, faces, weights, s)
        if not railed.any():
            return made
        at = np.flatnonzero(railed)
        who = ids[at]
        behind, ahead = self._gaps(places)
        tangent = self._along_rails(who, s[at], 0.25 * np.minimum(behind, ahead)[who])
        step = ((targets[at] - vertices[at]) * tangent).sum(axis=1)
        step = np.clip(step, -REACH * behind[who], REACH * ahead[who])
        return made.put(at, self._on_rails(who, s[at] + step))

    def tangents(self, places: Places, ids: IntArray) -> FloatArray:
        """Return the unit vectors (k, 2, 3) along which vertices may move, 0 if not along two.

        Parameters
        ----------
        places : Places
            Of all vertices.
        ids : (k,) int array
            Vertices.
        """
        face = places.faces[ids]
        found = np.stack([frame[face] for frame in self.mesh.surface.face_frames], axis=1)
        railed = self.rail[ids] >= 0
        if railed.any():
            who = ids[railed]
            small = 0.25 * np.minimum(*self._gaps(places))[who]
            found[railed] = 0.0
            found[railed, 0] = self._along_rails(who, places.s[who], small)
        return found

    def held_back(
        self, places: Places, moved: Places, quality: FloatArray, floor: FloatArray
    ) -> tuple[Places, FloatArray]:
        """Return moved places, those before for vertices of quads that are spoilt.

        Parameters
        ----------
        places : Places
            Of all vertices, before.
        moved : Places
            Of all vertices, after.
        quality : (q,) float array
            Scaled Jacobians of the quads before.
        floor : (q,) float array
            What none may fall below, or else not below what it was.

        Returns
        -------
        places : Places
        quality : (q,) float array
            Scaled Jacobians of the quads there.
        """
        quads = self.mesh.quads
        floor = np.minimum(floor, quality)
        found = self.quality(moved, quads)
        back = np.zeros(len(places.s), dtype=bool)
        while (found < floor).any():
            back[quads[found < floor]] = True
            ids = np.flatnonzero(back)
            moved = moved.put(ids, places.at(ids))
            touched = back[quads].any(axis=1)
            whole = back[quads].all(axis=1)
            found[whole] = quality[whole]
            some = np.flatnonzero(touched & ~whole)
            found[some] = self.quality(moved, quads[some])
        return moved, found

    def _on_rails(self, ids: IntArray, s: FloatArray) -> Places:
        """Return the places of vertices at lengths s along their rails."""
        made = Places(np.zeros((len(ids), 3)), np.zeros_like(ids), np.zeros((len(ids), 3)), s)
        for i, rail in enumerate(self.rails):
            on = np.flatnonzero(self.rail[ids] == i)
            if len(on):
                made = made.put(on, Places(rail.positions(s[on]), *rail.points(s[on]), s[on]))
        return made

    def _along_rails(self, ids: IntArray, s: FloatArray, small: FloatArray) -> FloatArray:
        """Return the unit tangents (k, 3) of rails, as differences over small lengths."""
        after, before = (self._on_rails(ids, s + d).vertices for d in (small, -small))
        return unit(after - before)

    def _gaps(self, places: Places) -> tuple[FloatArray, FloatArray]:
        """Return the lengths (n,) to the vertices behind and ahead on the same rail."""
        behind, ahead = np.zeros((2, len(self.rail)))
        for i, rail in enumerate(self.rails):
            on = np.flatnonzero(self.rail == i)
            if len(on) == 0:
                continue
            order = on[np.argsort(rail.inside(places.s[on]), kind="stable")]
            s = rail.inside(places.s[order])
            if rail.closed:
                gap = np.append(np.diff(s), s[0] + rail.length - s[-1])
                ahead[order], behind[order] = gap, np.roll(gap, 1)
            else:
                gap = np.concatenate([[s[0]], np.diff(s), [rail.length - s[-1]]])
                behind[order], ahead[order] = gap[:-1], gap[1:]
        return behind, ahead
