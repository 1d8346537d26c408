"""Values whose arrays nobody writes to."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

import numpy as np


def freeze_arrays(value: Any) -> None:
    """Make the arrays of a frozen dataclass read-only, for its ``__post_init__``.

    Those of the caller stay as they are: the value keeps views.

    Parameters
    ----------
    value : dataclass
        The value, just made.
    """
    for name in (each.name for each in fields(value)):
        if isinstance(array := getattr(value, name), np.ndarray):
            view = array.view()
            view.setflags(write=False)
            object.__setattr__(value, name, view)
