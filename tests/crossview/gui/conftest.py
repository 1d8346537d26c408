from tests.windowing import app, hand, nothing_left, settings, window

__all__ = ["app", "hand", "nothing_left", "settings", "window"]
