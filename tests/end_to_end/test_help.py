"""Help > User guide in the window: the page that fits, in its language, or where to find it."""

from __future__ import annotations

from pathlib import Path

import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QDesktopServices
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QPushButton
from window_tools import Script, run_bodiless

from app.gui.features.help import user_guide as guide
from app.gui.main_window import MainWindow
from app.i18n.catalog import using_language

pytestmark = pytest.mark.usefixtures("empty_house")

PAGES = ("index", "tutorial/quick-start", *(english.partition("#")[0] for english, _ in guide.PAGES.values()))


@pytest.fixture
def site(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A guide with all pages that the window may ask for."""
    folder = tmp_path / "a guide #1"
    folder.mkdir()
    for page in PAGES:
        path = folder / f"{page}.html"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.touch()
    monkeypatch.setattr(guide, "guide_folder", lambda: folder)
    return folder


@pytest.fixture
def opened(site: Path, monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """What a browser is asked to show, as pages of the guide."""
    pages: list[str] = []

    def show(url: object) -> bool:
        path = Path(url.toLocalFile())
        assert path.is_file()
        heading = f"#{url.fragment()}" if url.hasFragment() else ""
        pages.append(path.relative_to(site).with_suffix("").as_posix() + heading)
        return True

    monkeypatch.setattr(QDesktopServices, "openUrl", show)
    return pages


def go_everywhere(window: MainWindow) -> None:
    """Ask for the guide in every step, at the garment, at the report and on the start page."""
    for step in window.rail.items:
        window.navigation.show_step(step)
        window.actions_.guide.trigger()
    window.navigation.show_panel("garment")
    window.actions_.guide.trigger()
    window.model_controller.show()
    window.actions_.guide.trigger()
    window.report_controller.open()
    window.actions_.guide.trigger()
    window.start_controller.show_page()
    window.actions_.guide.trigger()


def test_f1_opens_the_page_that_fits_what_is_being_done(opened: list[str]) -> None:
    def script(window: MainWindow) -> Script:
        yield window.is_settled
        window.start_controller.tour.end()
        go_everywhere(window)
        assert opened == [
            *(
                "how-to/open-scan",
                "how-to/landmarks",
                "how-to/lines",
                "how-to/measurements",
                "how-to/pattern",
            ),
            *("how-to/cut-list", "reference/model-options", "how-to/report", "index"),
        ]
        opened.clear()
        window.activateWindow()
        yield window.isActiveWindow
        QTest.keyClick(window, Qt.Key.Key_F1)
        assert opened == ["index"]
        begin = next(
            each
            for each in window.start_controller.page.findChildren(QPushButton)
            if each.text() == "Quick start"
        )
        begin.click()
        assert opened == ["index", "tutorial/quick-start"]
        assert window.actions_.menus["help"].actions()[0] is window.actions_.guide
        assert window.notices.notice() is None
        where_nothing_opens_it_the_window_says_where_it_is(window)

    run_bodiless([], script)


def where_nothing_opens_it_the_window_says_where_it_is(window: MainWindow) -> None:
    begun = guide.guide_folder() / "tutorial" / "quick-start.html"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(QDesktopServices, "openUrl", lambda url: False)
        for expected in (str(begun), "make docs"):
            window.actions_.first_steps.trigger()
            notice = window.notices.notice()
            assert notice is not None
            assert expected in notice.hint
            window.notices.clear()
            begun.unlink(missing_ok=True)


def test_a_window_that_speaks_japanese_opens_the_japanese_part() -> None:
    with using_language("ja"):
        assert {guide.fitting_page(at).partition("#")[0] for at in guide.PAGES} == {"ja/screens"}
        assert guide.fitting_page("garment") == "ja/screens#裁断"
        assert (guide.fitting_page(""), guide.first_page()) == ("ja/index", "ja/quick-start")


@pytest.mark.parametrize("place", [each for both in guide.PAGES.values() for each in both])
def test_what_f1_opens_stands_in_the_guide(place: str) -> None:
    page, _, heading = place.partition("#")
    text = (Path(__file__).parents[2] / "docs" / f"{page}.md").read_text("utf-8")
    titles = [
        line.lstrip("# ").lower().replace(" ", "-") for line in text.splitlines() if line.startswith("## ")
    ]
    assert not heading or heading in titles


def test_the_built_guide_is_looked_for_beside_the_resources() -> None:
    assert guide.guide_folder() == Path(__file__).parents[2] / "site"


def test_of_a_guide_that_lies_elsewhere_its_own_place_is_asked_for(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "doc").mkdir()
    (tmp_path / "site").symlink_to(tmp_path / "doc")
    monkeypatch.setattr(guide.resources, "files", lambda _: tmp_path / "resources")
    assert guide.guide_folder() == (tmp_path / "doc").resolve()
