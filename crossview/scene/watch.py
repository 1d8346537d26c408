"""The diff: tells each layer whether what it depends on has changed since it last asked."""

from __future__ import annotations

from typing import Any

import numpy as np


class Watch:
    """Remembers values by name; arrays are compared by identity, all else by equality."""

    def __init__(self) -> None:
        self._seen: dict[str, tuple[Any, ...]] = {}

    def changed(self, name: str, *values: Any) -> bool:
        """Return whether `values` differ from those last given under `name`; remember them."""
        before = self._seen.get(name)
        # Holding the values also keeps an array's identity from being used again.
        self._seen[name] = values
        return before is None or not all(map(_same, before, values))


def _same(a: Any, b: Any) -> bool:
    if a is b:
        return True
    if isinstance(a, np.ndarray) or isinstance(b, np.ndarray):
        return False
    return bool(a == b)
