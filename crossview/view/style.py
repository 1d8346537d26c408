"""Widths of lines, and what lies before what."""

from __future__ import annotations

WIDTH = {
    "edges": 1.0,
    "crosses": 1.25,
    "separatrices": 2.25,
    "separatrices halo": 4.25,
    "layout": 2.0,
    "quads": 1.0,
    "features": 2.75,
    "boundary": 2.5,
    "cut": 2.75,
    "cut halo": 4.75,
    "loop": 5.0,
    "near misses": 3.0,
    "near misses halo": 5.0,
    "guide": 2.0,
    "guide halo": 4.0,
    "strong guide": 5.0,
    "strong guide halo": 8.0,
    "measure": 3.0,
    "measure halo": 6.0,
    "problem": 3.0,
}
"""Of lines, in pixels of the window. Chosen."""

TOWARDS = {
    "surface": 0.0,
    "quads": 0.0,
    "layout": 0.0,
    "crosses": 30.0,
    "layout borders": 40.0,
    "separatrices halo": 42.0,
    "separatrices": 68.0,
    "features": 70.0,
    "missed features": 75.0,
    "boundary": 80.0,
    "section": 80.0,
    "cut halo": 90.0,
    "cut": 100.0,
    "loop": 120.0,
    "curves on quads": 500.0,
    "near misses halo": 102.0,
    "near misses": 104.0,
    "guide halo": 105.0,
    "guide": 107.0,
    "strong guide halo": 110.0,
    "strong guide": 115.0,
    "measure halo": 550.0,
    "measure": 600.0,
    "measure dots": 2700.0,
    "problem faces": 150.0,
    "problem lines": 600.0,
    "problem dots": 900.0,
    "irregular": 2000.0,
    "T marks": 2200.0,
    "! marks": 2200.0,
    "singularities": 2500.0,
    "locks": 2520.0,
    "selection": 2500.0,
    "preview": 3000.0,
}
"""How far each is drawn towards the eye from where it is, in 1/65 536 of the depth seen.

Chosen: lines do not fight with the surface they lie on, and discs do not sink into it when seen
from the side.
"""
