"""What the table of actions calls: the session's verbs, and those that need a window."""

from __future__ import annotations

from typing import Protocol

from crossview.gui.appearance import Appearance
from crossview.gui.files import Files
from crossview.gui.help_page import Help
from crossview.session.session import Session


class WindowVerbs(Protocol):
    """What a window can do; menus, toolbar, shortcuts and palette know no more of it."""

    @property
    def session(self) -> Session:
        """The verbs that need no window."""

    @property
    def files(self) -> Files:
        """Opening, saving and exporting, with their dialogs."""

    @property
    def help(self) -> Help:
        """Keys, what this is, and what a report of trouble should tell."""

    @property
    def appearance(self) -> Appearance:
        """The preferences in force, and their dialog."""

    def add_pair(self) -> None:
        """Add a pair where the mouse is, where the menu was asked for, or where there is room."""

    def close(self) -> bool:
        """Close the window; False if it stays."""

    def edit_valence(self, index: int) -> None:
        """Let the valence of singularity `index` be typed."""

    def change_projection(self) -> None:
        """Show in perspective what is shown in parallel, or the other way round."""

    def toggle_clip(self) -> None:
        """Cut away the half that is nearer to the eye, or show all again."""

    def copy_camera(self) -> None:
        """Put the camera into the clipboard, as text."""

    def paste_camera(self) -> None:
        """Look with the camera that the clipboard holds."""

    def show_gallery(self) -> None:
        """Show the cases that come with crossview, to open one."""

    def escape(self) -> None:
        """Put a dragged singularity back, else take the select tool."""

    def look_from(self, camera: str) -> None:
        """Look from one of the scene's preset directions; "auto": a good side."""

    def make_quads(self) -> None:
        """Make quads as the Quads panel says, and show it."""

    def start_tour(self) -> None:
        """Open the case of the tour, and say step by step what to do with it."""

    def reset_docks(self) -> None:
        """Put all panels back to where they stand at first."""

    def simplify(self) -> None:
        """Merge singularities until as many are left as the Validity panel says."""

    def show_palette(self) -> None:
        """Open the command palette."""
