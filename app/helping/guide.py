"""The user guide: where it lies, which page fits what is being done, and how it is shown."""

from __future__ import annotations

from importlib import resources
from pathlib import Path

from app.helping.outside import open_outside
from app.panels.notice import NoticeBar
from app.wording.words import language, tr

PAGES = {
    "scan": "guide",
    "landmarks": "guide",
    "lines": "screens",
    "model": "method",
    "garment": "sewing",
    "result": "measures",
    "report": "report",
}
"""What is being done in the window, and the page that speaks of it."""

FIRST = "first"


def guide_folder() -> Path:
    """Return where the built guide lies, beside the resources; where that is a link, what it leads to.

    A browser that is kept in a box of its own may see ``/usr/share/doc`` and not the folder of the program.
    """
    return (Path(str(resources.files("resources"))).parent / "site").resolve()


def fitting_page(at: str) -> str:
    """Return the page for what is being done, a key of ``PAGES``, in the language of the window.

    Of the Japanese part one page speaks of all screens.
    """
    if language() == "ja":
        return "ja/screens" if at in PAGES else "ja/index"
    return PAGES.get(at, "index")


def first_page() -> str:
    """Return the page for somebody who is here for the first time."""
    return f"ja/{FIRST}" if language() == "ja" else FIRST


def show_page(page: str, notices: NoticeBar) -> None:
    """Show a page of the guide in the browser; where that does not go, say where it is."""
    path = guide_folder() / f"{page}.html"
    if path.is_file() and open_outside(path):
        return
    if path.is_file():
        hint = tr("Open this file in a browser: {file}").format(file=path)
    else:
        hint = tr("It is not built here. In a checkout of Busk, 'make docs' builds it.")
    notices.show_notice("info", tr("The user guide cannot be opened here."), hint, lasting=True)
