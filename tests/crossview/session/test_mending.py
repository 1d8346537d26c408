import numpy as np
import pytest

from crossview.cases.model import Case
from crossview.session.commands import (
    AddSingularities,
    ChangeValence,
    ChooseMethod,
    RemoveSingularities,
)
from crossview.session.document import Document
from crossview.session.mending import mend, mendings
from solvers.errors import SingularityError
from solvers.progress import run
from solvers.remedies import ANISOTROPIC, RepairSurface
from solvers.singularities import Singularity, SplitOne, far_points, require_places
from solvers.validity import ValidityError, make_valid


def document(surface: dict[str, object], *singularities: tuple[list[float], int]) -> Document:
    placed = [{"position": p, "valence": v} for p, v in singularities]
    return Document.from_case("case", Case.from_json({"surface": surface, "singularities": placed}))


def test_a_bare_sphere_is_offered_one_or_all_eight() -> None:
    sphere = document({"builtin": "sphere"})
    one, all_eight, distributed = mendings(sphere)
    assert (one.label, all_eight.label) == ("Add one valence 3", "Add all 8 valence 3")
    assert distributed.label == "Distribute the missing index"
    mended = run(mend(sphere, all_eight)).apply(sphere)
    assert mended.budget.satisfied
    positions = mended.surface.positions([s.point for s in mended.singularities])
    gaps = np.linalg.norm(positions[:, None] - positions, axis=2)[np.triu_indices(8, 1)]
    # eight points on the unit sphere are at best 1.215 apart (the anticube)
    assert gaps.min() > 0.75
    assert mendings(mended) == ()


def test_each_offer_of_one_step_brings_the_sum_nearer() -> None:
    for configuration in (
        document({"builtin": "disk"}, ([0.0, 0.0, 0.0], 3)),
        document({"builtin": "annulus"}, ([0.7, 0.0, 0.0], 5)),
        document({"builtin": "torus"}, ([1.4, 0.0, 0.0], 6), ([-1.4, 0.0, 0.0], 3)),
    ):
        offers = mendings(configuration)
        assert offers
        for offer in offers:
            changed = run(mend(configuration, offer)).apply(configuration)
            assert abs(changed.budget.missing) < abs(configuration.budget.missing)


def test_a_change_of_valence_is_offered_when_one_can_take_it_all() -> None:
    torus = document({"builtin": "torus"}, ([1.4, 0.0, 0.0], 6), ([-1.4, 0.0, 0.0], 3))
    labels = {offer.label: offer for offer in mendings(torus)}
    assert "Make #2 a valence 2" in labels
    assert run(mend(torus, labels["Make #2 a valence 2"])) == ChangeValence(1, 2)


def test_one_that_would_become_regular_is_offered_to_go() -> None:
    torus = document({"builtin": "torus"}, ([1.4, 0.0, 0.0], 5))
    labels = {offer.label: offer for offer in mendings(torus)}
    assert run(mend(torus, labels["Delete #1"])) == RemoveSingularities(frozenset({0}))


def test_locked_ones_are_left_alone() -> None:
    torus = document({"builtin": "torus"}, ([1.4, 0.0, 0.0], 5))
    locked = torus.with_singularities([Singularity(torus.singularities[0].point, 5, locked=True)])
    assert all(isinstance(run(mend(locked, o)), AddSingularities) for o in mendings(locked))


def test_what_an_error_of_the_document_offers_becomes_a_command() -> None:
    torus = document({"builtin": "torus"}, ([1.4, 0.0, 0.0], 5), ([-1.4, 0.0, 0.0], 3))
    assert run(mend(torus, ANISOTROPIC)) == ChooseMethod("anisotropic")
    with pytest.raises(ValidityError) as refused:
        run(make_valid(torus.surface, torus.singularities))
    (pair,) = refused.value.remedies
    valid = run(mend(torus, pair)).apply(torus)
    assert [s.valence for s in valid.singularities] == [5, 3, 3, 5]
    with pytest.raises(TypeError):  # the window repairs files, no document does
        run(mend(torus, RepairSurface("repair it")))


def test_far_points_keep_off_the_boundary_and_each_other() -> None:
    annulus = document({"builtin": "annulus"})
    points = run(far_points(annulus.surface, (), 4))
    radii = np.linalg.norm(annulus.surface.positions(points), axis=1)
    assert np.all((radii > 0.55) & (radii < 0.85))


@pytest.mark.parametrize("builtin", ["sphere", "disk"])
def test_far_points_are_distinct_vertices(builtin: str) -> None:
    surface = document({"builtin": builtin}).surface
    positions = surface.positions(run(far_points(surface, (), 12)))
    assert len(np.unique(positions, axis=0)) == 12
    to_vertices = np.linalg.norm(positions[:, None] - surface.vertices, axis=2).min(axis=1)
    assert to_vertices.max() < 1e-12


def test_singularities_at_wrong_places_are_mended() -> None:
    together = [([0.3, 0.2, 0.0], 3), ([0.3, 0.2, 0.0], 3)]
    for configuration in (
        document({"builtin": "disk"}, ([1.0, 0.0, 0.0], 3), ([0.0, 0.0, 0.0], 1)),
        document({"builtin": "disk"}, *together, ([-0.3, 0.0, 0.0], 2)),
    ):
        with pytest.raises(SingularityError) as refused:
            require_places(configuration.surface, configuration.singularities)
        (remedy,) = refused.value.remedies
        mended = run(mend(configuration, remedy)).apply(configuration)
        require_places(mended.surface, mended.singularities)
        assert mended.budget.satisfied


def test_a_valence_1_is_split() -> None:
    one = document({"builtin": "disk"}, ([0.0, 0.0, 0.0], 1), ([0.5, 0.0, 0.0], 3))
    mended = run(mend(one, SplitOne("split #1", 0))).apply(one)
    assert [s.valence for s in mended.singularities] == [2, 3, 3]
