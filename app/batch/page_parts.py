"""Parts of pages of analyses: tables, numbers and the page around them; no network, no script."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from html import escape
from importlib import resources

MINUS, UNKNOWN = "\N{MINUS SIGN}", "\N{EN DASH}"


@dataclass(frozen=True)
class Cell:
    """A cell of a table with the class of its look: "number", "good", "bad" or, as a text, ""."""

    text: str
    look: str = ""


Row = list[Cell | str]
"""The cells of a row; texts are those without a look."""


def number(value: float | None, digits: int = 1, *, signed: bool = False) -> Cell:
    """Return a number as a cell, a dash if it is not known."""
    if value is None:
        return Cell(UNKNOWN, "number")
    text = f"{value:{'+' if signed else ''}.{digits}f}"
    if float(text) == 0.0:
        text = text.lstrip("+-")
    return Cell(text.replace("-", MINUS), "number")


def percent(share: float | None) -> str:
    """Return a share as whole percent."""
    return UNKNOWN if share is None else f"{100.0 * share:.0f} %"


def counted(count: int, one: str, many: str) -> str:
    """Return a number of things in words."""
    return f"{count} {one if count == 1 else many}"


def table(heading: Sequence[str], rows: Iterable[Sequence[Cell | str]]) -> str:
    """Return a table as HTML; columns whose first row is a number are aligned on the right."""
    cells = [[each if isinstance(each, Cell) else Cell(each) for each in row] for row in rows]
    looks = [each.look for each in cells[0]] if cells else [""] * len(heading)
    head = "".join(_cell("th", Cell(text, look)) for text, look in zip(heading, looks, strict=True))
    body = "".join(f"<tr>{''.join(_cell('td', each) for each in row)}</tr>" for row in cells)
    return f'<div class="scroll"><table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table></div>'


def _cell(tag: str, cell: Cell) -> str:
    look = f' class="{cell.look}"' if cell.look and (tag == "td" or cell.look == "number") else ""
    return f"<{tag}{look}>{escape(cell.text)}</{tag}>"


def paragraph(text: str, *, note: bool = False) -> str:
    """Return a text as a paragraph."""
    look = ' class="note"' if note else ""
    return f"<p{look}>{escape(text)}</p>"


def folded(title: str, content: str) -> str:
    """Return a part that is shown on request."""
    return f"<details><summary>{escape(title)}</summary>{content}</details>"


def page(title: str, body: str) -> str:
    """Return the page with this title and HTML."""
    text = (resources.files("resources") / "pages" / "analysis.html").read_text(encoding="utf-8")
    return text.replace("<!--title-->", escape(title)).replace("<!--body-->", body)
