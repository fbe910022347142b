"""Headings of the lines below the bust, by where a garment has them; each opens and closes its rows."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from PySide6.QtWidgets import QVBoxLayout, QWidget

from app.gui.features.lines.row import LineRow
from app.gui.widgets.basic import Disclosure
from app.i18n.catalog import tr
from core.document.lower_trunk import GROUPS


def _titles() -> dict[str, str]:
    return {"waist": tr("Waist and belly"), "seat": tr("Hips and seat"), "legs": tr("Legs")}


class LineGroups:
    """The headings in a column of rows; while one is closed, only lines that are worn stand under it.

    ``changed`` is called when one was opened or closed.
    """

    def __init__(self, column: QVBoxLayout, owner: QWidget, changed: Callable[[], None]) -> None:
        self._column = column
        self.headings = {name: Disclosure(title) for name, title in _titles().items()}
        for heading in self.headings.values():
            heading.setParent(owner)  # also while no row stands under it
            heading.hide()
            heading.toggled.connect(lambda _: changed())

    def lay(self, rows: Sequence[LineRow]) -> None:
        """Put rows into the column in their order, each group under its heading."""
        for heading in self.headings.values():
            self._column.removeWidget(heading)
        place, seen = 0, {"bust"}
        for row in rows:
            group = row.view.group
            if group in GROUPS and group not in seen:
                self._column.insertWidget(place, self.headings[group])
                place += 1
            seen.add(group)
            self._column.insertWidget(place, row)
            place += 1
        for group, heading in self.headings.items():
            heading.setVisible(group in seen)

    def show(self, rows: Sequence[LineRow], selected: str | None) -> None:
        """Show the rows that are seen: all of groups that are open, else those worn, and the selected one."""
        for row in rows:
            heading = self.headings.get(row.view.group)
            open_ = heading is None or heading.isChecked()
            row.setVisible(open_ or row.view.worn or row.view.name == selected)
