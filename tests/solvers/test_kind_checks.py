"""Points, singularities and features from outside: those of another kind are refused in one line,
and what may be gone through only once counts as often as it is needed."""

from collections.abc import Callable, Iterable
from types import MappingProxyType
from typing import Any

import numpy as np
import pytest

from solvers.errors import CrossviewError
from solvers.features import Features
from solvers.fields import IsotropicSolver, natural_singularities, prepare
from solvers.primitives import annulus, disk, plate_with_holes
from solvers.progress import run
from solvers.singularities import (
    Singularity,
    far_points,
    index_budget,
    merged,
    mirrored,
    pair_at,
    rotated,
    split,
)
from solvers.surface import EdgePaths, SurfacePoint, refine_at, straightest
from solvers.validity import Guide, make_valid, missing_singularities

SURFACE = annulus(inner=0.4, n=24)
SOLVER = IsotropicSolver(SURFACE)
PAIR = [
    Singularity(SURFACE.closest_point([0.8, 0.1, 0.0]), 3),
    Singularity(SURFACE.closest_point([0.6, -0.1, 0.0]), 5),
]
MIDDLE = SURFACE.closest_point([0.7, 0.0, 0.0])
PREPARED = prepare(SURFACE, PAIR, refine=0)
GUIDE = Guide(SOLVER.holonomy, PAIR, moving=0)

TAKES_SINGULARITIES: dict[str, Callable[[Any], Any]] = {
    "solve": lambda s: SOLVER.solve(s).H.tolist(),
    "cut_graph": lambda s: SOLVER.cut_graph(s).tolist(),
    "defects": lambda s: SOLVER.holonomy.defects(s).tolist(),
    "prepare": lambda s: prepare(SURFACE, s, refine=1).singularities,
    "with_valences": lambda s: PREPARED.with_valences(s).singularities,
    "index_budget": lambda s: index_budget(SURFACE, s, {}),
    "far_points": lambda s: run(far_points(SURFACE, s, count=2)),
    "pair_at": lambda s: pair_at(SURFACE, s, MIDDLE, 0.1),
    "merged": lambda s: merged(SURFACE, s, 0, 1),
    "mirrored": lambda s: mirrored(SURFACE, s, axis=0),
    "rotated": lambda s: rotated(SURFACE, s, axis=2, angle=1.0),
    "missing_singularities": lambda s: run(missing_singularities(SOLVER, s)),
    "make_valid": lambda s: run(make_valid(SURFACE, s, levels=1)).singularities,
    "Guide": lambda s: Guide(SOLVER.holonomy, s, moving=1).closing(0).faces.tolist(),
}


@pytest.mark.parametrize("name", TAKES_SINGULARITIES)
def test_singularities_may_come_one_after_the_other(name: str) -> None:
    use = TAKES_SINGULARITIES[name]
    assert use(s for s in PAIR) == use(PAIR) == use(np.array(PAIR, dtype=object))


@pytest.mark.parametrize("wrong", [None, 3, "35", PAIR[0], [PAIR[0], None], [PAIR[0].point]])
@pytest.mark.parametrize("name", [*TAKES_SINGULARITIES, "split"])
def test_something_else_than_singularities_is_refused(name: str, wrong: Any) -> None:
    uses = TAKES_SINGULARITIES | {"split": lambda s: split(SURFACE, s, 0)}
    with pytest.raises(CrossviewError, match=r"^singularities must (each )?be .* Singularity, not"):
        uses[name](wrong)


def test_singularities_taken_one_after_the_other_are_all_solved() -> None:
    field = SOLVER.solve(s for s in PAIR)
    assert [s.valence for s in field.singularities] == [3, 5]


@pytest.mark.parametrize(
    ("point", "valence", "locked", "said"),
    [
        (None, 3, False, "the point of a singularity must be a SurfacePoint, not None"),
        ([0.8, 0.0, 0.0], 3, False, "must be a SurfacePoint, not a list: take one of the surface"),
        (MIDDLE, 3, "no", "locked must be True or False, not 'no'"),
        (MIDDLE, 3, None, "locked must be True or False, not None"),
    ],
)
def test_a_singularity_is_made_of_what_it_says(
    point: Any, valence: int, locked: Any, said: str
) -> None:
    with pytest.raises(CrossviewError, match=said):
        Singularity(point, valence, locked)


def test_a_singularity_locked_by_numpy_is_locked() -> None:
    assert Singularity(MIDDLE, 3, np.bool_(True)).locked is True  # type: ignore[arg-type]


TAKES_POINTS: dict[str, Callable[[Any], Any]] = {
    "positions": lambda points: SURFACE.positions(points).tolist(),
    "refine_at": lambda points: refine_at(SURFACE, points, levels=1).vertices.tolist(),
    "gradients": lambda points: SOLVER.holonomy.gradients(points).tolist(),
}


@pytest.mark.parametrize("name", TAKES_POINTS)
def test_points_may_come_one_after_the_other(name: str) -> None:
    points = [s.point for s in PAIR]
    use = TAKES_POINTS[name]
    assert use(point for point in points) == use(points)


@pytest.mark.parametrize("wrong", [None, 3, "ab", MIDDLE, [MIDDLE, None], [[0.8, 0.0, 0.0]]])
@pytest.mark.parametrize("name", TAKES_POINTS)
def test_something_else_than_points_is_refused(name: str, wrong: Any) -> None:
    with pytest.raises(CrossviewError, match=r"^points must (each )?be .* SurfacePoint, not"):
        TAKES_POINTS[name](wrong)


@pytest.mark.parametrize("wrong", [None, 3, (0, (1, 0, 0)), [0.8, 0.0, 0.0], PAIR[0]])
@pytest.mark.parametrize(
    "use",
    [
        SURFACE.position,
        SURFACE.nearest_vertex,
        lambda point: straightest(SURFACE, point, [0.1, 0.0]),
        lambda point: pair_at(SURFACE, [], point, 0.1),
        lambda point: GUIDE.kept(0, point),
    ],
)
def test_something_else_than_a_point_is_refused(use: Callable[[Any], Any], wrong: Any) -> None:
    with pytest.raises(CrossviewError, match=r"must (each )?be a SurfacePoint, not"):
        use(wrong)


@pytest.mark.parametrize("wrong", [None, 3, "abc", [1.0, 0.0], [[1, 0, 0]], [np.nan, 0, 1]])
def test_weights_of_a_point_are_three_numbers(wrong: Any) -> None:
    with pytest.raises(CrossviewError, match="the barycentric weights of a point must be"):
        SURFACE.point(0, wrong)


@pytest.mark.parametrize("wrong", [None, "xy", [1.0], [1.0, 0.0, 0.0], [np.nan, 0.0], [np.inf, 0]])
def test_a_walk_goes_along_two_finite_numbers(wrong: Any) -> None:
    with pytest.raises(CrossviewError, match="the vector must be"):
        straightest(SURFACE, MIDDLE, wrong)


EDGES = SURFACE.edges
INNER = np.flatnonzero(SURFACE.edge_faces[:, 1] >= 0)


@pytest.mark.parametrize("wrong", [[len(EDGES)], [-1], [1.5], [[1, 2]], [True], "ab", 3])
@pytest.mark.parametrize(
    "use",
    [
        lambda edges: Features(SURFACE, edges),
        lambda edges: Features(SURFACE, INNER[:3]).united(edges),
        lambda edges: refine_at(SURFACE, [], feature_edges=edges),
    ],
)
def test_there_is_no_edge_of_such_a_number(use: Callable[[Any], Any], wrong: Any) -> None:
    with pytest.raises(CrossviewError, match="the numbers of edges must be"):
        use(wrong)


@pytest.mark.parametrize("wrong", [[0, SURFACE.n_vertices], [-1], [0.5], 3, "ab", [True]])
@pytest.mark.parametrize("use", [EdgePaths(SURFACE).through, SURFACE.loop_length])
def test_there_is_no_vertex_of_such_a_number(use: Callable[[Any], Any], wrong: Any) -> None:
    with pytest.raises(CrossviewError, match="the numbers of vertices must be"):
        use(wrong)


def test_an_edge_of_the_boundary_is_no_feature() -> None:
    border = np.flatnonzero(SURFACE.edge_faces[:, 1] < 0)
    with pytest.raises(CrossviewError, match="edges on the boundary are no features"):
        Features(SURFACE, border[:1])


def test_features_are_the_same_in_any_order_and_nobody_changes_them() -> None:
    given = INNER[[7, 2, 7, 4]]
    features = Features(SURFACE, given)
    assert features.edges.tolist() == sorted({*given.tolist()})
    before = features.edges.copy()
    given[:] = 0
    assert (features.edges == before).all()
    with pytest.raises(ValueError, match="read-only"):
        features.edges[0] = 1


@pytest.mark.parametrize(
    "use",
    [
        lambda surface, features: IsotropicSolver(surface, features=features),
        lambda surface, features: prepare(surface, features=features),
        lambda surface, features: run(natural_singularities(surface, features=features)),
    ],
)
def test_features_of_another_surface_are_refused(use: Callable[[Any, Any], Any]) -> None:
    other = plate_with_holes(edge_length=0.3)
    inner = np.flatnonzero(other.edge_faces[:, 1] >= 0)
    with pytest.raises(CrossviewError, match="features of another surface are given"):
        use(SURFACE, Features(other, inner[:4]))


def test_corners_may_be_any_mapping_and_nothing_else() -> None:
    surface = disk(edge_length=0.3)
    vertex = int(surface.boundary_loops[0][0])
    numbers: Any = MappingProxyType({np.int64(vertex): np.float64(1.0)})
    for given in ({vertex: 1}, numbers):
        assert IsotropicSolver(surface, given).corners == {vertex: 1}
        assert prepare(surface, corners=given).corners == {vertex: 1}
    wrong: Iterable[Any] = ([(vertex, 1)], "auto", 3)
    half: Any = {vertex: 0.5}
    for given in wrong:
        for use in (IsotropicSolver, lambda s, c: prepare(s, corners=c)):
            with pytest.raises(CrossviewError, match="the corners must be a Mapping, not"):
                use(surface, given)
    for use in (IsotropicSolver, lambda s, c: prepare(s, corners=c)):
        with pytest.raises(CrossviewError, match=r"the index of corner \d+ must be a whole number"):
            use(surface, half)


@pytest.mark.parametrize("wrong", [-1, 2, True, 0.5, None, "0"])
def test_a_guide_is_for_one_singularity_and_one_condition(wrong: Any) -> None:
    with pytest.raises(CrossviewError, match="the number of the singularity that moves must be"):
        Guide(SOLVER.holonomy, PAIR, moving=wrong)
    for use in (GUIDE.closing, GUIDE.keeping, lambda i: GUIDE.kept(i, MIDDLE)):
        with pytest.raises(CrossviewError, match="the number of a holonomy condition must be"):
            use(wrong)


@pytest.mark.parametrize("wrong", [-1, True, 1.5, None, "2"])
def test_a_number_of_points_is_a_whole_number(wrong: Any) -> None:
    with pytest.raises(CrossviewError, match="the number of points must be"):
        run(far_points(SURFACE, [], wrong))


def test_a_point_by_hand_is_still_a_point() -> None:
    assert SURFACE.require_own([SurfacePoint(0, (1, 0, 0))]) == (SurfacePoint(0, (1, 0, 0)),)
