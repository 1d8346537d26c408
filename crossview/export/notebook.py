"""A figure that turns in a notebook."""

from __future__ import annotations

from dataclasses import dataclass
from html import escape


@dataclass(frozen=True)
class NotebookPicture:
    """A page of `web_page`, as Jupyter shows it.

    Parameters
    ----------
    page : str
        HTML that loads nothing from elsewhere.
    height : int
        Pixels; it is as wide as its cell.
    """

    page: str
    height: int

    def __repr__(self) -> str:
        """Short, where nothing is drawn."""
        return f"<picture of {len(self.page):,} bytes>"

    def _repr_html_(self) -> str:
        return (
            f'<iframe srcdoc="{escape(self.page)}" width="100%" height="{self.height}" '
            'style="border: 0"></iframe>'
        )
