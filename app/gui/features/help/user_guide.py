"""The user guide: where it lies, which page fits what is being done, and how it is shown."""

from __future__ import annotations

from importlib import resources
from pathlib import Path

from app.gui.session.app_folders import open_outside
from app.gui.session.notifications import Notifications
from app.i18n.catalog import language, tr

PAGES = {
    "scan": ("how-to/open-scan", "ja/screens#五つの手順"),
    "landmarks": ("how-to/landmarks", "ja/screens#五つの手順"),
    "lines": ("how-to/lines", "ja/screens#ライン"),
    "model": ("reference/model-options", "ja/screens#ライン"),
    "garment": ("how-to/cut-list", "ja/screens#裁断"),
    "result": ("how-to/measurements", "ja/screens#寸法"),
    "pattern": ("how-to/pattern", "ja/screens#型紙"),
    "report": ("how-to/report", "ja/screens#レポート"),
}
"""What is being done in the window, and where the guide speaks of it, in English and in Japanese."""

FIRST = ("tutorial/quick-start", "ja/quick-start")
"""The page for a first design, in English and in Japanese."""


def guide_folder() -> Path:
    """Return where the built guide lies, beside the resources; where that is a link, what it leads to.

    A browser that is kept in a box of its own may see ``/usr/share/doc`` and not the folder of the program.
    """
    return (Path(str(resources.files("resources"))).parent / "site").resolve()


def fitting_page(at: str) -> str:
    """Return where the guide speaks of what is being done, a key of ``PAGES``, in the window's language."""
    english, japanese = PAGES.get(at, ("index", "ja/index"))
    return japanese if language() == "ja" else english


def first_page() -> str:
    """Return the page for somebody who is here for the first time."""
    return FIRST[language() == "ja"]


def show_page(page: str, notifications: Notifications) -> None:
    """Show a page of the guide in the browser, from ``#`` a heading on; where that fails, say where it is."""
    name, _, heading = page.partition("#")
    path = guide_folder() / f"{name}.html"
    if path.is_file() and open_outside(path, heading):
        return
    if path.is_file():
        hint = tr("Open this file in a browser: {file}").format(file=path)
    else:
        hint = tr(
            "The user guide has not been built. When running Busk from source code, build the guide "
            "with 'make docs'."
        )
    notifications.info(tr("The user guide could not be opened."), hint, lasting=True)
