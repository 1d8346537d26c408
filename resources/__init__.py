"""What crossview ships beside its code, read through importlib.resources."""
