"""Cases: surface, singularities and options, as JSON files."""
