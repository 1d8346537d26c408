"""From a triangle soup to a surface, and what that took."""
