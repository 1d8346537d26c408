"""What can be done in a session, each group for one matter.

A verb changes the document by a command or the state by a transition; what takes longer than a
look-up goes to the background through `Solving`.
"""
