"""Feature edges: sharp or marked edges inside a surface that crosses are to follow."""
