"""Smoothing of a quad mesh on its surface: every quad is drawn towards a rectangle.

Local step: each quad asks its corners to be those of the nearest rectangle whose sides are its own
mean sides, drawn somewhat towards those it had at first, so that sizes and aspects stay. Global
step: each vertex takes the mean of what its quads ask for, small quads counting as much as large
ones, and is put back on the surface or on its rail. Each quad has a floor, what it was at first or
a good value; where one would fall below, its vertices stay. Quads that are inverted all the same
are unfolded together with those around.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from solvers.kind_checks import one_of_kind
from solvers.number_checks import whole_number
from solvers.quads.corners import unit, worth
from solvers.quads.incidence import grown
from solvers.quads.quadmesh import QuadMesh
from solvers.quads.rails import Rail, boundary_rails
from solvers.quads.sliding import SAME_PLACE, Places, Sliding
from solvers.quads.unfolding import ENOUGH, unfold
from solvers.quads.untangling import POOR, improve_worst
from solvers.surface.triangulation import BoolArray, FloatArray, IntArray

ROUNDS = 30
"""How often all vertices move. Chosen."""

STAGES = 2
"""How often poor quads are improved one by one at most, and these rounds run again. Chosen."""

UNFOLDINGS = 4
"""How often quads that are still inverted are unfolded, as long as fewer are left. Chosen."""

PULL = 0.3
"""How much of a rectangle's sides, in logarithms, is what they were at first: 0 none, 1 all.

Chosen.
"""

WORST = 0.1
"""What the worst quad counts beside the mean of all, when rounds are compared. Chosen."""

PATIENCE, LITTLE = 5, 1e-4
"""Rounds that each gain less than so little quality, after which no more are tried. Chosen."""

SLIM = 50.0
"""Longest side of a quad, in its shortest, beyond which it counts as poorer in the end.

Measured: without, sides shrink to 1e-9 of others where fields stretch.
"""

RINGS = 4
"""How many rings of quads around poor ones are smoothed again with them.

Measured: with all quads, no fewer are left inverted, in twice the time.
"""

GOOD = 0.5
"""Scaled Jacobian that a quad may fall to for the sake of others. Chosen: angles of 30 degrees."""


def smooth(
    mesh: QuadMesh,
    *,
    curves: Sequence[IntArray] = (),
    rounds: int = ROUNDS,
) -> QuadMesh:
    """Return a mesh with quads more like rectangles, none worse than before and than `GOOD`.

    Where quads are inverted, those around them may become worse too, if fewer are left inverted,
    but none than the worst. So no more are inverted, and the least scaled Jacobian is no lower,
    unless it was good.
    Vertices stay on the surface, those of a boundary or a curve on it, fixed ones where they are.
    The nearest vertex is put on each sharp turn of a boundary or a curve that has none, if that
    spoils no quad.

    Parameters
    ----------
    mesh : QuadMesh
        What to smooth.
    curves : sequence of (k,) int array, optional
        Chains of surface vertices joined by edges; the first again at the end of a closed one.
        Edges of the mesh that lie on one stay on it.
    rounds : int, optional
        How often all vertices move.

    Returns
    -------
    QuadMesh
        The same quads, other places.

    Raises
    ------
    CrossviewError
        If a curve is no chain of vertices joined by edges.

    Notes
    -----
    The local step is shape matching (Bouaziz et al. 2012, "Shape-Up").

    Examples
    --------
    A vertex that was moved off its place in a regular grid goes back:

    >>> from dataclasses import replace
    >>> from solvers import run
    >>> from solvers.fields import IntegratedField, aligned_field, prepare
    >>> from solvers.layouts import quad_layout
    >>> from solvers.primitives import square
    >>> from solvers.quads import fill, quantize, smooth
    >>> aligned = aligned_field(prepare(square(n=4)))
    >>> layout = run(quad_layout(IntegratedField(aligned, aligned.start)))
    >>> grid = fill(layout, quantize(layout.tmesh, edge_length=1 / 3).counts)
    >>> vertices = grid.vertices.copy()
    >>> vertices[grid.boundary_loop < 0] += [0.05, 0.02, 0.0]
    >>> moved = replace(grid, vertices=vertices)
    >>> smoothed = smooth(moved)
    >>> bool(moved.scaled_jacobian.min() < 0.99 < smoothed.scaled_jacobian.min())
    True
    """
    *_, last = smoothing_stages(mesh, curves=curves, rounds=rounds)
    return last


def smoothing_stages(
    mesh: QuadMesh, *, curves: Sequence[IntArray] = (), rounds: int = ROUNDS
) -> Iterator[QuadMesh]:
    """Yield the mesh once all is smooth, with poor quads improved, with inverted ones unfolded.

    As far as there are any. Each is better by the scaled Jacobians of its quads than the one
    before, which a judge with other normals may see otherwise.

    Parameters
    ----------
    mesh : QuadMesh
        As of `smooth`, which returns the last.
    curves : sequence of (k,) int array, optional
        As of `smooth`.
    rounds : int, optional
        As of `smooth`.

    Yields
    ------
    QuadMesh
        The same quads, other places.

    Raises
    ------
    CrossviewError
        As of `smooth`.

    Examples
    --------
    >>> from solvers import run
    >>> from solvers.fields import IntegratedField, aligned_field, prepare
    >>> from solvers.layouts import quad_layout
    >>> from solvers.primitives import square
    >>> from solvers.quads import fill, quantize, smoothing_stages
    >>> aligned = aligned_field(prepare(square(n=4)))
    >>> layout = run(quad_layout(IntegratedField(aligned, aligned.start)))
    >>> grid = fill(layout, quantize(layout.tmesh, edge_length=1 / 3).counts)
    >>> len(list(smoothing_stages(grid)))
    1
    """
    rounds = whole_number("rounds of smoothing", rounds, 0)
    rails = boundary_rails(mesh.surface)
    rail, held = mesh.boundary_loop.copy(), mesh.fixed.copy()
    one_of_kind("the curves", curves, Sequence, "give a list")  # type: ignore[type-abstract]
    for curve in curves:
        rails.append(Rail(mesh.surface, curve))
        on = _run_along(mesh, rails[-1])
        # What lies on two curves, or on one and the boundary, is held by both.
        held[on[rail[on] >= 0]] = True
        rail[on] = np.where(rail[on] >= 0, rail[on], len(rails) - 1)
    sliding = Sliding(replace(mesh, fixed=held), rails, rail)
    start = sliding.start()
    quality = sliding.quality(start, mesh.quads)
    least = quality.min(initial=1.0)
    floor = _floor(quality, least)
    smoothed, free = _smoothed(floor, sliding, start, rounds)
    yield _placed(mesh, smoothed)
    improved = found = _improved(sliding, smoothed, free, floor, rounds)
    if improved is not smoothed:
        yield _placed(mesh, improved)
    for _ in range(UNFOLDINGS):
        poor = sliding.quality(found, mesh.quads) < ENOUGH
        if not poor.any():
            break
        found, before = _unfolded(_around(sliding, poor), found, least, rounds), found
        if found is before:
            break
    found = _widened(sliding, found, rounds)
    if found is not improved:
        yield _placed(mesh, found)


def _placed(mesh: QuadMesh, places: Places) -> QuadMesh:
    return replace(mesh, vertices=places.vertices, faces=places.faces, barycentric=places.weights)


def _around(sliding: Sliding, some: BoolArray) -> Sliding:
    """Return what holds the vertices of some quads (q,) and of `RINGS` rings around them."""
    return sliding.part(grown(sliding.mesh.quads, some, RINGS))


def _widened(sliding: Sliding, found: Places, rounds: int) -> Places:
    """Return places without sides of nearly no length, if no more quads are inverted there."""
    strict = Sliding(sliding.mesh, sliding.rails, sliding.rail, SLIM)
    quads = sliding.mesh.quads
    slim = strict.quality(found, quads) < np.minimum(sliding.quality(found, quads), ENOUGH)
    if not slim.any():
        return found
    sliding, strict = _around(sliding, slim), _around(strict, slim)
    quads = sliding.mesh.quads
    tried = _kept_above(np.minimum(strict.quality(found, quads), GOOD), strict, found, rounds)
    now, then = (worth(sliding.quality(places, quads)) for places in (found, tried))
    return tried if then[0] >= now[0] and then[1] >= min(now[1], ENOUGH) else found


def _unfolded(sliding: Sliding, found: Places, least: float, rounds: int) -> Places:
    """Return places with fewer inverted quads than those found, none worse than the least."""
    quads = sliding.mesh.quads
    free = np.flatnonzero(~sliding.mesh.fixed)
    tried = unfold(sliding, found, free, _sides(sliding.mesh))
    floor = _floor(sliding.quality(tried, quads), least)
    tried = _kept_above(floor, sliding, tried, rounds)
    now, then = (worth(sliding.quality(places, quads)) for places in (found, tried))
    return tried if then > now and then[1] >= least else found


def _floor(quality: FloatArray, least: float) -> FloatArray:
    """Return what quads may not fall below: the least of all for those that are inverted.

    Some unfold only if they may fold further on the way.
    """
    return np.where(quality > 0, np.minimum(quality, GOOD), least)


def _kept_above(floor: FloatArray, sliding: Sliding, start: Places, rounds: int) -> Places:
    """Return smooth places with poor quads improved, all above a floor."""
    return _improved(sliding, *_smoothed(floor, sliding, start, rounds), floor, rounds)


def _smoothed(
    floor: FloatArray, sliding: Sliding, start: Places, rounds: int
) -> tuple[Places, IntArray]:
    """Return smooth places, vertices on as many sharp turns of rails as leave all above a floor.

    And the vertices that may still move.
    """
    snapped, held = sliding.snapped(start)
    while True:
        places = _rounds(sliding, snapped, _free(sliding, held), floor, rounds)
        spoilt = sliding.mesh.quads[sliding.quality(places, sliding.mesh.quads) < floor]
        if len(held) == 0 or len(spoilt) == 0:
            break
        # Let go of the corners that cost too much; if it is not they, of all.
        guilty = np.isin(held, spoilt)
        held = held[~guilty] if guilty.any() else held[:0]
        snapped = start.put(held, snapped.at(held))
    return places, _free(sliding, held)


def _free(sliding: Sliding, held: IntArray) -> IntArray:
    """Return the vertices that may move, with some held besides those that are fixed."""
    fixed = sliding.mesh.fixed.copy()
    fixed[held] = True
    return np.flatnonzero(~fixed)


def _run_along(mesh: QuadMesh, rail: Rail) -> IntArray:
    """Return the vertices of the edges of a mesh that lie on a rail."""
    gap = np.linalg.norm(rail.positions(rail.nearest(mesh.vertices)) - mesh.vertices, axis=1)
    near = gap < SAME_PLACE * mesh.surface.diagonal
    return np.unique(mesh.edges[near[mesh.edges].all(axis=1)])


def _improved(
    sliding: Sliding, places: Places, free: IntArray, floor: FloatArray, rounds: int
) -> Places:
    """Return places with poor quads improved one by one, all others after them."""
    for _ in range(STAGES):
        if sliding.quality(places, sliding.mesh.quads).min(initial=1.0) >= POOR:
            break
        places = improve_worst(sliding, places, free, floor)
        places = _rounds(sliding, places, free, floor, rounds)
    return places


def _rounds(
    sliding: Sliding, places: Places, free: IntArray, floor: FloatArray, rounds: int
) -> Places:
    """Return the best places of many rounds, which end when they lead to nothing better."""
    sides = _sides(sliding.mesh)
    quality = sliding.quality(places, sliding.mesh.quads)
    best, best_score, since = places, _score(quality), 0
    for _ in range(rounds):
        places, quality = _round(sliding, places, quality, free, floor, sides)
        score = _score(quality)
        since = 0 if score > best_score + LITTLE else since + 1
        if score > best_score:
            best, best_score = places, score
        if since == PATIENCE:
            break
    return best


def _score(quality: FloatArray) -> float:
    return float(quality.mean() + WORST * quality.min()) if len(quality) else 0.0


def _round(
    sliding: Sliding,
    places: Places,
    quality: FloatArray,
    free: IntArray,
    floor: FloatArray,
    sides: FloatArray,
) -> tuple[Places, FloatArray]:
    """Return places and qualities after two steps that leave no quad below its floor."""
    mesh, quads = sliding.mesh, sliding.mesh.quads
    outward = sliding.normals(places, quads).sum(axis=1)
    asked = rectangles(places.vertices[quads], outward, sides).reshape(-1, 3)
    weight = np.repeat(1 / sides.prod(axis=0), 4)
    total = [np.bincount(quads.reshape(-1), weight * x, mesh.n_vertices) for x in asked.T]
    weights = np.bincount(quads.reshape(-1), weight, mesh.n_vertices)
    means = np.stack(total, axis=1)[free] / weights[free, None]
    moved = places.put(free, sliding.moved(places, free, means))
    return sliding.held_back(places, moved, quality, floor)


def rectangles(corners: FloatArray, outward: FloatArray, sides: FloatArray) -> FloatArray:
    """Return, for each quad, the nearest rectangle of about its own sides.

    Parameters
    ----------
    corners : (q, 4, 3) float array
        Counter-clockwise seen from outside.
    outward : (q, 3) float array
        Vectors that point to the outside; a quad that is inverted asks to be turned back.
    sides : (2, q) float array
        Lengths that the sides, from corner 0 to 1 and from 1 to 2, are drawn to.

    Returns
    -------
    (q, 4, 3) float array
        Corners of the rectangles.
    """
    first, second = _mean_sides(corners)
    width, height = np.linalg.norm([first, second], axis=2) ** (1 - PULL) * sides**PULL
    first, second = unit(first), unit(second)
    over = (np.cross(first, second) * outward).sum(axis=1) <= 0
    # The diagonals of the square on unit vectors along the mean sides are orthogonal.
    long, short = unit(first + second), first - second
    short = unit(np.where(over[:, None], np.cross(long, outward), short))
    u = np.sqrt(0.125) * width[:, None] * (long + short)
    v = np.sqrt(0.125) * height[:, None] * (long - short)
    middle = corners.mean(axis=1)
    return np.stack([middle - u - v, middle + u - v, middle + u + v, middle - u + v], axis=1)


def _sides(mesh: QuadMesh) -> FloatArray:
    """Return the lengths (2, q) of the mean sides of quads, none of no length."""
    sides = np.linalg.norm(_mean_sides(mesh.vertices[mesh.quads]), axis=2)
    return np.asarray(np.maximum(sides, 1e-9 * sides.max(initial=1e-300)))


def _mean_sides(corners: FloatArray) -> FloatArray:
    """Return (2, q, 3) the means of opposite sides of quads (q, 4, 3)."""
    a, b, c, d = (corners[:, i] for i in range(4))
    return 0.5 * np.stack([b - a + c - d, c - b + d - a])
