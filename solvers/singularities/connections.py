"""Connections: which singularities are to be joined by separatrices."""

from __future__ import annotations

from collections.abc import Sequence

from solvers.errors import CrossviewError, SingularityError
from solvers.number_checks import whole_numbers

Connections = tuple[tuple[int, int], ...]
"""Numbers of singularities from 0, the lower of each two first, in ascending order."""


def checked_connections(
    connections: Sequence[tuple[int, int]],
    count: int,
    *,
    error: type[CrossviewError] = SingularityError,
) -> Connections:
    """Return connections given from outside in their one form.

    Parameters
    ----------
    connections : sequence of (int, int)
        Numbers of singularities from 0, as often as separatrices join the two.
    count : int
        How many singularities there are.
    error : type, optional
        What is raised.

    Returns
    -------
    tuple of (int, int)
        The lower number of each two first, in ascending order.

    Raises
    ------
    SingularityError
        Or `error`, if one is no pair of numbers of singularities.

    Examples
    --------
    >>> from solvers.singularities import checked_connections
    >>> checked_connections([(3, 1), (0, 1)], 4)
    ((0, 1), (1, 3))
    >>> checked_connections([(3, 1)], 3)
    Traceback (most recent call last):
    solvers.errors.SingularityError: connections must be whole numbers from 0 to 2, not 3 (row 0)
    """
    if not len(connections):
        return ()
    if not count:
        raise error("there are no singularities to be connected", "connections")
    found = whole_numbers("connections", connections, (None, 2), below=count, error=error)
    return tuple(sorted((min(pair), max(pair)) for pair in found.tolist()))
