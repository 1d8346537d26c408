"""The certificate: meshes of arithmetic, each with one fault, and what must not matter."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from crossview.certificate import Certificate, Faces, Irregular, Reference, Sizes, certify
from crossview.certificate.angles import corner_angles
from solvers.errors import CrossviewError
from tests.crossview.certificate.meshes import (
    annulus,
    flat,
    halved,
    lattice,
    moved,
    on_roof,
    quads_of,
    ring,
    roof,
    square,
    unit_square,
    with_faces,
    with_points,
)


def kinds(found: Certificate) -> set[str]:
    return {fault.kind for fault in found.faults}


def test_squares_on_a_square_are_right() -> None:
    found = certify(square(8), unit_square())
    assert found.right
    assert found.inverted == 0
    corners, distances = found.measures["corners"], found.measures["distances"]
    assert corners["min_degrees"] == pytest.approx(90)
    assert corners["max_degrees"] == pytest.approx(90)
    assert corners["mean_scaled_jacobian"] == pytest.approx(1)
    assert distances.pop("area_ratio") == pytest.approx(1)
    assert max(distances.values()) < 1e-9
    assert found.measures["mean_edge"] == pytest.approx(1 / 8)
    assert found.measures["irregular"]["found"] == {}
    assert found.measures["irregular_on_boundary"]["found"] == {"1": 4}
    assert found.measures["topology"]["mesh"] == found.measures["topology"]["surface"]


def test_an_inverted_corner_is_found() -> None:
    # the vertex at (1/2, 1/2) goes over the diagonal of the quad up and to the right of it
    found = certify(moved(square(8), 40, [0.58, 0.57, 0]), unit_square())
    assert kinds(found) == {"inverted"}
    assert found.inverted == found.measures["corners"]["inverted_corners"] == 1
    (fault,) = found.faults
    assert fault.place == pytest.approx((0.5825, 0.58, 0))


def test_a_corner_above_180_degrees_that_the_quads_own_normal_hides_is_found() -> None:
    # unfolded, the slopes are a plane in which x is twice as long: 230 degrees at the last corner
    places = [(-0.8, -0.3), (0.5, -0.7), (0.5, 0.8), (-0.2, 0.4)]
    quad = on_roof(60, places)
    surface = roof(60)
    own = np.cross(quad[2] - quad[0], quad[3] - quad[1])
    ahead = np.roll(quad, -1, axis=0) - quad
    assert (np.cross(ahead, -np.roll(ahead, 1, axis=0)) @ own > 0).all()
    mesh = Faces.of_one_size(quad, [[0, 1, 2, 3]])
    angles = corner_angles(mesh, surface.triangles, surface.ground)
    assert np.flatnonzero(angles.inverted).tolist() == [3]


def test_a_corner_on_a_crease_has_the_normal_of_its_own_side() -> None:
    # 2 x 2 rectangles, two on each slope, unfolded all angles are right
    places = [(x, y) for y in (-1, 0, 1) for x in (-1, 0, 1)]
    mesh = Faces.of_one_size(on_roof(75, places), lattice(2, 2))
    surface = roof(75)
    angles = corner_angles(mesh, surface.triangles, surface.ground)
    np.testing.assert_allclose(angles.degrees, 90, atol=1e-6)


def test_angles_of_a_rhombus() -> None:
    shear = flat(6) @ np.array([[1, 0, 0], [0.5, 3**0.5 / 2, 0], [0, 0, 1]])
    surface = Reference(Faces.of_one_size(shear, halved(lattice(6, 6))))
    found = certify(Faces.of_one_size(shear, lattice(6, 6)), surface)
    corners = found.measures["corners"]
    assert corners["min_degrees"] == pytest.approx(60)
    assert corners["max_degrees"] == pytest.approx(120)
    assert corners["min_scaled_jacobian"] == pytest.approx(3**0.5 / 2)


def test_a_side_without_length_is_inverted() -> None:
    mesh = square(4)
    found = certify(moved(mesh, 12, mesh.points[13]), unit_square())
    assert "inverted" in kinds(found)
    assert found.inverted == 2  # of the four around, two share the side


def test_a_side_of_hardly_any_length_is_told() -> None:
    # the vertex in the middle goes along an edge to near its other end
    mesh = square(4)
    for gap, found in ((2e-4, {"slivers"}), (2e-2, set())):
        near = certify(moved(mesh, 12, mesh.points[13] - [gap / 4, 0, 0]), unit_square())
        assert kinds(near) == found
        assert near.inverted == 0
        assert near.measures["corners"]["max_side_ratio"] == pytest.approx(
            np.hypot(1 - gap, 1) / gap
        )
    assert near.measures["corners"]["slivers"] == 0


def test_a_corner_of_180_degrees_or_more_at_a_valence_2_is_excused_and_told() -> None:
    for middle in (0.5, 0.6):
        points = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [middle, 1 - middle, 0]])
        found = certify(Faces.of_one_size(points, [[0, 1, 2, 4], [0, 4, 2, 3]]), unit_square())
        assert found.right
        assert found.measures["corners"]["excused_at_valence_2"] == 1
        assert found.measures["irregular"]["found"] == {"2": 1}


def test_a_folded_valence_2_is_not_excused() -> None:
    points = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [1.2, 0.1, 0]], dtype=float)
    found = certify(Faces.of_one_size(points, [[0, 1, 2, 4], [0, 4, 2, 3]]), unit_square())
    assert found.inverted == 1


def test_a_twisted_quad_is_found() -> None:
    quads = quads_of(mesh := square(8))
    quads[27] = quads[27, [0, 2, 1, 3]]
    found = certify(with_faces(mesh, quads), unit_square())
    assert "inverted" in kinds(found)
    assert "topology" in kinds(found)
    assert found.inverted == 1


def test_a_turned_quad_is_found_once() -> None:
    quads = quads_of(mesh := square(8))
    quads[27] = quads[27, ::-1]
    found = certify(with_faces(mesh, quads), unit_square())
    assert kinds(found) == {"turned"}
    assert str(found.faults[0]).startswith("1 face oriented against the others, the first at")


def test_a_mesh_that_is_inside_out_is_found_once() -> None:
    mesh = square(8)
    found = certify(with_faces(mesh, quads_of(mesh)[:, ::-1]), unit_square())
    assert kinds(found) == {"inside out"}
    assert found.measures["corners"]["max_degrees"] == pytest.approx(90)


def test_a_moebius_strip_has_one_side() -> None:
    n, t = 24, np.linspace(0, 2 * np.pi, 24, endpoint=False)
    h, t = np.repeat([-0.2, 0.2], n), np.tile(t, 2)
    r = 1 + h * np.cos(t / 2)
    points = np.stack([r * np.cos(t), r * np.sin(t), h * np.sin(t / 2)], axis=1)
    quads = [[i, i + 1, n + i + 1, n + i] for i in range(n - 1)] + [[n - 1, n, 0, 2 * n - 1]]
    found = certify(Faces.of_one_size(points, quads), unit_square())
    assert not found.measures["counts"]["two_sided"]
    assert "one-sided" in kinds(found)


def test_edges_of_three_quads_are_found() -> None:
    mesh = square(8)
    fin = np.array([[0.5, 0.5, 0.1], [0.625, 0.5, 0.1]])
    points = np.concatenate([mesh.points, fin])
    quads = np.concatenate([quads_of(mesh), [[40, 41, 82, 81]]])
    found = certify(Faces.of_one_size(points, quads), unit_square())
    assert "non-manifold edges" in kinds(found)
    assert found.measures["counts"]["non_manifold_edges"] == 1


def test_vertices_where_faces_only_touch_are_found() -> None:
    quads = np.delete(quads_of(square(8)), [27, 36], axis=0)  # both have the vertex in the middle
    found = certify(with_faces(square(8), quads), unit_square())
    assert found.measures["counts"]["non_manifold_vertices"] == 1
    assert {"non-manifold vertices", "topology"} <= kinds(found)


def test_faces_of_other_numbers_of_corners_are_counted() -> None:
    mesh = square(8)
    sizes, corners = np.full(65, 4), np.insert(mesh.corners, 108, mesh.corners[[108, 109, 110]])
    corners = np.delete(corners, [111 + 1])  # the quad becomes two triangles
    sizes[27:29] = 3
    found = certify(Faces(mesh.points, sizes, corners), unit_square())
    assert found.measures["counts"]["non_quads"] == 2
    assert kinds(found) == {"non-quads"}


def test_a_vertex_twice_in_a_face_is_found() -> None:
    quads = quads_of(mesh := square(8))
    quads[27, 1] = quads[27, 0]
    found = certify(with_faces(mesh, quads), unit_square())
    assert "repeating" in kinds(found)


def test_a_boundary_that_is_lost_is_found() -> None:
    # the hole of the ring is closed by quads between pairs of pairs of its sides
    mesh = annulus()
    points = np.concatenate([mesh.points, [[0.0, 0, 0]]])
    lid = [[i + 1, i, len(points) - 1, (i + 2) % 60] for i in range(0, 60, 2)]
    found = certify(Faces.of_one_size(points, np.concatenate([quads_of(mesh), lid])), ring())
    assert {"topology", "surface", "boundary", "area"} <= kinds(found)


def test_a_boundary_where_the_surface_has_none_is_found() -> None:
    quads = np.delete(quads_of(square(8)), 27, axis=0)
    found = certify(with_faces(square(8), quads), unit_square())
    assert {"topology", "boundary"} <= kinds(found)
    assert found.measures["distances"]["boundary_to_surface"] == pytest.approx(4 / 8)


def test_a_row_of_quads_that_is_missing_is_found() -> None:
    found = certify(with_faces(annulus(), quads_of(annulus())[:300]), ring())
    assert {"area"} == kinds(found)
    left = 0.5 ** (1 / 6) * np.cos(np.pi / 60)  # as near to the centre as its sides come
    far = found.measures["distances"]["surface_to_boundary"]
    assert far == pytest.approx(1 - left)


def test_an_edge_that_cuts_across_a_circle_is_off_the_boundary() -> None:
    # one boundary quad spans 84 degrees: vertices lie on the circle, its edge 0.26 inside
    angle = 2 * np.pi * np.concatenate([[0], np.linspace(84, 360, 60)[:-1]]) / 360
    radius = np.linspace(0.5, 1, 7)
    r, a = np.repeat(radius, 60), np.tile(-angle, 7)
    points = np.stack([r * np.cos(a), r * np.sin(a), 0 * r], axis=1)
    found = certify(Faces.of_one_size(points, lattice(60, 6, around=True)), ring())
    far = found.measures["distances"]["surface_to_boundary"]
    assert far == pytest.approx(1 - np.cos(np.radians(42)), rel=0.01)
    assert {"boundary", "surface", "area"} <= kinds(found)


def test_a_vertex_off_the_surface_is_off_both_ways() -> None:
    found = certify(moved(square(8), 40, [0.5, 0.5, 0.3]), unit_square())
    assert found.measures["distances"]["faces_to_surface"] == pytest.approx(0.3)
    assert "surface" in kinds(found)


def test_a_mesh_in_another_unit_is_off_and_measured_in_few_places() -> None:
    found = certify(with_points(square(8), 1e6 * flat(8)), unit_square())
    assert {"surface", "boundary", "area"} <= kinds(found)
    assert found.measures["distances"]["area_ratio"] == pytest.approx(1e12)


def test_a_bump_that_the_mesh_misses_is_off() -> None:
    n = 32
    points = flat(n)
    far = np.linalg.norm(points[:, :2] - 0.5, axis=1)
    points[:, 2] = 0.3 * np.clip(1 - far / 0.1, 0, None)
    surface = Reference(Faces.of_one_size(points, halved(lattice(n, n))))
    found = certify(square(8), surface)
    assert found.measures["distances"]["surface_to_faces"] == pytest.approx(0.3)
    assert "surface" in kinds(found)


def test_a_feature_through_the_middles_of_faces_is_off_the_edges() -> None:
    for y, far in ((0.5, 0.0), (0.5 + 1 / 16, 0.5)):
        line = np.array([[[0.0, y, 0], [1.0, y, 0]]])
        found = certify(square(8), replace(unit_square(), features=line))
        distance = found.measures["distances"]["features_to_edges"]
        assert distance * 8 == pytest.approx(far, abs=1e-9)
        assert found.right == (far == 0)


def test_a_wanted_valence_that_is_missing_is_found() -> None:
    wanted = Irregular(np.array([[0.5, 0.5, 0]]), np.array([3]))
    (fault,) = certify(square(8), replace(unit_square(), singularities=wanted)).faults
    assert str(fault) == "1 irregular vertex missing, the first, of 3 faces, at (0.5, 0.5, 0)"


def test_irregular_vertices_are_where_they_should_be() -> None:
    corners = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    ones = np.ones(4, dtype=np.int64)
    assert certify(square(8), replace(unit_square(), corners=Irregular(corners, ones))).right
    shifted = corners + np.array([[0, 0.1, 0], [0, 0, 0], [0, 0, 0], [0, 0, 0]])
    found = certify(square(8), replace(unit_square(), corners=Irregular(shifted, ones)))
    assert kinds(found) == {"irregular"}
    assert found.measures["irregular_on_boundary"]["max_distance"] == pytest.approx(0.8)
    found = certify(square(8), replace(unit_square(), corners=Irregular(corners[:3], ones[:3])))
    assert "1 irregular vertex too many" in str(found.faults[0])


def test_sizes_that_follow_the_radius() -> None:
    points = ring().surface.points
    faces = ring().surface.corners.reshape(-1, 3)
    radius = np.log(np.linalg.norm(points, axis=1))
    for factor in (1.0, 2.0):
        sizes = Sizes(points[faces], (factor * radius)[faces])
        found = certify(annulus(), replace(ring(), sizes=sizes)).measures["sizes"]
        assert found["slope"] == pytest.approx(1 / factor, rel=1e-2)
        assert (found["scatter"] < 5e-3) == (factor == 1)


def test_the_number_wanted_is_compared() -> None:
    for wanted, right in ((64, True), (60, True), (50, False), (80, False)):
        assert certify(square(8), replace(unit_square(), faces=wanted)).right == right


def test_neither_motion_nor_scale_nor_numbering_matters() -> None:
    rng = np.random.default_rng(3)
    mesh = moved(square(8), 40, [0.58, 0.57, 0.05])
    surface = unit_square()
    measured = certify(mesh, surface)
    turn, scale, shift = Rotation.random(rng=rng).as_matrix(), 1e-4, np.array([3.0, -1, 2])
    order = rng.permutation(81)
    renumbered = np.empty_like(order)
    renumbered[order] = np.arange(81)
    points = scale * (mesh.points @ turn.T + shift)
    quads = rng.permutation(renumbered[quads_of(mesh)], axis=0)
    other = Reference(
        with_points(surface.surface, scale * (surface.surface.points @ turn.T + shift))
    )
    again = certify(Faces.of_one_size(points[order], quads), other)
    assert kinds(again) == kinds(measured)
    for name in ("counts", "topology", "irregular", "irregular_on_boundary"):
        assert again.measures[name] == measured.measures[name]
    assert again.measures["corners"] == pytest.approx(measured.measures["corners"], rel=1e-6)
    lengths = measured.measures["distances"] | {"area_ratio": 1.0}
    found = again.measures["distances"] | {"area_ratio": 1.0}
    for name, far in lengths.items():
        factor = 1.0 if name == "area_ratio" else scale
        assert found[name] == pytest.approx(factor * far, rel=1e-6, abs=1e-9 * scale)


@pytest.mark.parametrize(
    ("points", "sizes", "corners", "said"),
    [
        (flat(1), [], [], "without faces"),
        (flat(1), [4], [0, 1, 3, 9], "outside 0..3"),
        (flat(1), [2], [0, 1], "fewer than three"),
        (flat(1) * np.nan, [4], [0, 1, 3, 2], "not all finite"),
    ],
)
def test_what_is_no_mesh_is_refused(
    points: np.ndarray, sizes: list[int], corners: list[int], said: str
) -> None:
    with pytest.raises(CrossviewError, match=said):
        Faces(points, np.array(sizes, dtype=np.int64), np.array(corners, dtype=np.int64))


def test_a_mesh_without_area_is_refused() -> None:
    with pytest.raises(CrossviewError, match="no area"):
        certify(with_points(square(2), 0 * flat(2)), unit_square())
