"""The window without a window: what is open, what is shown of it, and all that can be done.

Neither Qt nor VTK is imported here, so that every behaviour of the window that is not about
pixels can be tested without a display. `session.Session` needs nothing but a `loop.Loop`: the
window's events, or a queue. Its verbs (`verbs/`) change the document by commands that can be
undone (`commands`, `history`) and the one frozen state by transitions (`state`, `shown`); what
takes longer than a look-up runs in the background (`jobs`, `background`), and observers hear of
each new state.
"""
