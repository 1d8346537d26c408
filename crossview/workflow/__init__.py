"""From a case to its problem, solution, layout and quads."""
