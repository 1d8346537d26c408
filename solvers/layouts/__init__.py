"""From a field to its separatrices, and to the rectangles they cut a surface into."""
