"""The questions that a window stops for: which file, under which name, and what to do first."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TypeAlias

from PySide6.QtWidgets import QFileDialog, QMessageBox, QWidget

Answer: TypeAlias = QMessageBox.StandardButton


def ask_target(
    parent: QWidget, title: str, suggested: Path, kinds: Mapping[str, str]
) -> Path | None:
    """Ask where to write; None if that is given up.

    Parameters
    ----------
    parent : QWidget
        What the dialog stands over.
    title : str
    suggested : Path
        Its suffix names the kind that is chosen at first.
    kinds : mapping of str to str
        Words for each suffix; a name without a suffix gets that of the kind chosen.
    """
    filters = {f"{words} (*{suffix})": suffix for suffix, words in kinds.items()}
    dialog = QFileDialog(parent, title, str(suggested.parent), ";;".join(filters))
    dialog.setAcceptMode(QFileDialog.AcceptMode.AcceptSave)
    dialog.filterSelected.connect(lambda words: dialog.setDefaultSuffix(filters[words]))
    first = next(words for words, suffix in filters.items() if suffix == suggested.suffix)
    dialog.selectNameFilter(first)
    dialog.setDefaultSuffix(suggested.suffix)
    dialog.selectFile(suggested.name)
    taken = bool(dialog.exec())
    chosen = dialog.selectedFiles()
    dialog.deleteLater()
    return Path(chosen[0]) if taken and chosen else None


def ask_to_save(parent: QWidget, name: str) -> Answer:
    """Ask whether the changes of `name` are saved before they are left: Save, Discard, Cancel."""
    box = QMessageBox(parent)
    box.setIcon(QMessageBox.Icon.Warning)
    box.setWindowTitle("crossview")
    box.setText(f"Save the changes of {name}?")
    box.setInformativeText("They are lost otherwise.")
    box.setStandardButtons(Answer.Save | Answer.Discard | Answer.Cancel)
    box.setDefaultButton(Answer.Save)
    box.setEscapeButton(Answer.Cancel)
    answer = Answer(box.exec())
    box.deleteLater()
    return answer
