"""The open document, its history and its background jobs, without Qt or VTK."""
