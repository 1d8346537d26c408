"""The window. The only room that imports PySide6.

State flows one way: a `Session` holds one frozen `SessionState` and tells of each change; panels
and the viewport show it, and what the user does calls a verb of the session. A part of the window
is given the session, actions and a parent, never the window: `main_window` alone knows all parts.
"""
