"""The triangle surface: points, connectivity, validation, loops, paths, refinement."""
