"""Surfaces from files: those of tests/data, in every clone, and more where there are more.

CROSSVIEW_DATA names a folder of more; without it one called shared/data beside the clone counts.
"""

import os
from dataclasses import dataclass
from pathlib import Path

DATA = Path(__file__).resolve().parent / "data"
MORE = Path(os.environ.get("CROSSVIEW_DATA", DATA.parents[2] / "shared" / "data"))


@dataclass(frozen=True)
class Facts:
    """What is known of a file's surface."""

    vertices: int
    faces: int
    genus: int
    boundary_loops: int

    @property
    def euler_characteristic(self) -> int:
        return 2 - 2 * self.genus - self.boundary_loops


KNOWN = {
    "sphere.obj": Facts(642, 1280, 0, 0),
    "spot_low_resolution.obj": Facts(829, 1654, 0, 0),
    "torus.obj": Facts(2304, 4608, 1, 0),
    "hand_lowres.obj": Facts(810, 1602, 0, 1),
    "goathead.obj": Facts(2763, 5522, 0, 0),
    "wingnut.obj": Facts(3047, 6090, 0, 0),
    "skull_low_resolution.obj": Facts(5154, 10312, 2, 0),
    "demosthenes-low-res.obj": Facts(8394, 16719, 0, 1),
    "plate_holes.stl": Facts(618, 1252, 5, 0),
    "pointy.obj": Facts(399, 720, 0, 1),
    "gen_annulus.obj": Facts(1369, 2556, 0, 2),
}
PATHS = {
    name: folder / name for folder in (MORE, DATA) for name in KNOWN if (folder / name).is_file()
}
REAL = {name: facts for name, facts in KNOWN.items() if name in PATHS}
