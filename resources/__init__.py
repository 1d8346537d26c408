"""What crossview ships beside its code: gallery cases and icons (read through importlib.resources)."""
