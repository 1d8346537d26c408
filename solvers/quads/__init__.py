"""From a layout to quads: whole numbers for its arcs, grids in its rectangles, smoothing."""
