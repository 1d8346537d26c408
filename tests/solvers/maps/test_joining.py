"""Maps on which combinations of images vanish, against least squares with the same conditions."""

import numpy as np
from scipy.sparse import csr_array, random_array

from solvers.maps.seamless import SeamlessFit
from tests.solvers.layouts.fields import FIELDS


def random_rows(fit: SeamlessFit, count: int) -> csr_array:
    """Random combinations that nearly vanish already: what is met turns nothing over."""
    n = 6 * fit.matching.triangulation.n_faces
    rng = np.random.default_rng(count)
    rows = random_array((count, n), density=5e-3, rng=rng, data_sampler=rng.normal).toarray()
    images = fit.map.images.reshape(-1)
    return csr_array(rows - 0.999 * np.outer(rows @ images / (images @ images), images))


def test_combinations_vanish_and_the_distance_is_known_without_a_solve() -> None:
    fit = SeamlessFit(FIELDS["disk with four"]())
    rows = random_rows(fit, 3)
    joining = fit.joining(rows)
    joined = fit.joined(joining, np.inf)
    assert joined is not None
    images = joined.map.images.reshape(-1)
    before = np.abs(rows @ fit.map.images.reshape(-1)).max()
    assert np.abs(rows @ images).max() < 1e-6 * before
    np.testing.assert_allclose(joined.map.distance, fit.distance(joining), rtol=1e-9)
    # triangles close as before
    assert np.abs(joined.map.images.sum(axis=1)).max() < 1e-12 * np.abs(images).max()


def test_what_is_joined_in_two_steps_is_what_is_joined_in_one() -> None:
    fit = SeamlessFit(FIELDS["disk with four"]())
    rows = random_rows(fit, 8)
    whole = fit.joining(rows)
    first = fit.joined(fit.joining(rows[:3]), np.inf)
    assert first is not None
    steps = first.joining(rows[3:])
    np.testing.assert_allclose(steps.compliance, whole.compliance, rtol=1e-6, atol=1e-12)
    np.testing.assert_allclose(first.distance(steps), fit.distance(whole), rtol=1e-9)


def test_a_row_said_twice_counts_once_and_rows_on_nothing_pull_nothing() -> None:
    fit = SeamlessFit(FIELDS["disk with four"]())
    rows = random_rows(fit, 3)
    twice = csr_array(rows[[0, 1, 2, 1]])
    np.testing.assert_allclose(
        fit.distance(fit.joining(twice)), fit.distance(fit.joining(rows)), rtol=1e-7
    )
    none = csr_array((2, rows.shape[1]))
    assert fit.distance(fit.joining(none)) == fit.distance(fit.joining(none).first(0))
