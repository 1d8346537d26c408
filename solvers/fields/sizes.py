"""Size maps: wanted quad sizes, one or two for each vertex of a surface."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from solvers.errors import CrossviewError
from solvers.number_checks import LARGEST, real_numbers
from solvers.surface.triangulation import FloatArray


def size_map(
    sizes: npt.ArrayLike,
    n_vertices: int,
    where: str = "sizes",
    *,
    error: type[CrossviewError] = CrossviewError,
) -> FloatArray:
    """Return a size map as an array.

    Parameters
    ----------
    sizes : (n,) or (n, 2) array_like of float
        What was given: a size for each vertex, or one along the branch nearer to the x axis and
        one across, in the surface's unit of length.
    n_vertices : int
        Of the surface.
    where : str, optional
        What the error calls the place it stands.
    error : type, optional
        What is raised.

    Returns
    -------
    (n,) or (n, 2) float array
        The same sizes.

    Raises
    ------
    CrossviewError
        Or `error`, unless they are one or two positive finite sizes for each vertex.

    Examples
    --------
    >>> from solvers.fields import size_map
    >>> size_map([1, 2, 0.5], 3).tolist()
    [1.0, 2.0, 0.5]
    >>> size_map([1, -2, 0.5], 3)
    Traceback (most recent call last):
    solvers.errors.CrossviewError: a size is not positive and finite (sizes, vertex 1): ...
    """
    try:
        values = real_numbers("the size map", sizes, error=error)
    except error as wrong:
        wrong.locate(where)
        raise
    if values.shape not in ((n_vertices,), (n_vertices, 2)):
        shape = " x ".join(map(str, values.shape))
        held = f"{shape} numbers" if shape else "a single number"
        raise error(
            f"the size map has {held} for {n_vertices} vertices",
            where,
            "give one or two sizes for each vertex",
        )
    good = ((values > 0) & (values < LARGEST)).reshape(n_vertices, -1).all(axis=1)
    bad = np.flatnonzero(~good)
    if len(bad):
        what = "a size is" if len(bad) == 1 else f"{len(bad)} sizes are"
        first = "" if len(bad) == 1 else "the first at "
        raise error(
            f"{what} not positive and finite", f"{where}, {first}vertex {bad[0]}", "mend them"
        )
    return values
