"""What the user is working on: the document, its commands, undo and redo, and background jobs.

Neither Qt nor VTK is imported here, so that every behaviour of the window that is not about
pixels can be tested without a display.
"""
