"""What Sphinx needs besides its own extensions: formulas, and what the program writes."""
