"""The window. The only room that imports PySide6.

State flows one way: `workspace.Workspace` holds one frozen `SessionState` and tells of each change;
panels and the viewport show it, and what the user does calls a verb of the workspace.
"""
