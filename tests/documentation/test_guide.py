"""The user guide: pages are listed, links and pictures exist, and the built guide holds all it shows."""

from __future__ import annotations

import importlib.util
import re
from pathlib import Path
from urllib.parse import unquote

import pytest
from PIL import Image

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
PAGES = [ROOT / "README.md", *sorted(DOCS.rglob("*.md"))]
LINK = re.compile(r"(!?)\[([^]]*)\]\(([^)\s]+)\)")


def text_of(page: Path) -> str:
    """A page without its examples: what looks like a link in them is none."""
    return re.sub(r"^```.*?^```|`[^`\n]*`", "", page.read_text("utf-8"), flags=re.MULTILINE | re.DOTALL)


def title_of(page: Path) -> str:
    return page.read_text("utf-8").partition("\n")[0].removeprefix("# ")


def headings_of(page: Path) -> set[str]:
    """The names of a page's headings, as code hosts and the guide make them."""
    lines = re.sub(r"^```.*?^```", "", page.read_text("utf-8"), flags=re.MULTILINE | re.DOTALL).splitlines()
    titles = [line.lstrip("# ").lower() for line in lines if re.match("#+ ", line)]
    return {re.sub(r"[^\w\- ]", "", title).replace(" ", "-") for title in titles}


def links(page: Path) -> list[tuple[str, str, str]]:
    """The links of a page that lead to files of the repository: picture or not, words, where to."""
    return [link for link in LINK.findall(text_of(page)) if not re.match(r"\w+:", link[2])]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_every_link_and_picture_leads_somewhere(page: Path) -> None:
    missing = []
    for _, _, target in links(page):
        name, _, heading = target.partition("#")
        there = (page.parent / name).resolve() if name else page
        if not there.is_file() or (heading and heading not in headings_of(there)):
            missing.append(target)
    assert missing == []


def test_the_first_page_lists_every_page_once_by_its_title() -> None:
    for index in (DOCS / "index.md", DOCS / "ja" / "index.md"):
        listed = re.findall(r"^- \[(.*?)\]\(([\w/-]+\.md)\)", index.read_text("utf-8"), re.MULTILINE)
        others = {page for page in index.parent.rglob("*.md") if page != index}
        if index.parent == DOCS:
            others -= set((DOCS / "ja").glob("*.md"))
        assert sorted(index.parent / name for _, name in listed) == sorted(others)
        assert [words for words, _ in listed] == [title_of(index.parent / name) for _, name in listed]


def test_every_page_has_one_title() -> None:
    counts = {}
    for page in PAGES:
        lines = re.sub(r"^```.*?^```", "", page.read_text("utf-8"), flags=re.MULTILINE | re.DOTALL)
        counts[page.name] = len(re.findall(r"^# ", lines, re.MULTILINE))
    assert {name: count for name, count in counts.items() if count != 1} == {}


def builder():
    """The module that builds the guide."""
    spec = importlib.util.spec_from_file_location("guide_builder", ROOT / "packaging" / "guide.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The guide, built: warnings of Sphinx end it."""
    folder = tmp_path_factory.mktemp("guide")
    builder().build(folder / "site", folder / "work")
    return folder / "site"


def test_every_picture_is_shown_by_a_page(site: Path) -> None:
    shown = {path.read_bytes() for path in site.rglob("_images/*")}
    readme = {(ROOT / link).resolve() for mark, _, link in links(ROOT / "README.md") if mark}
    pictures = set(DOCS.rglob("*.png")) - readme
    assert [path.name for path in pictures if path.read_bytes() not in shown] == []


def test_the_built_guide_holds_all_that_its_pages_load(site: Path) -> None:
    pages = {page.relative_to(DOCS).with_suffix(".html") for page in DOCS.rglob("*.md")}
    assert [str(page) for page in pages if not (site / page).is_file()] == []
    assert builder().loaded_from_elsewhere(site) == []
    assert 'lang="ja"' in (site / "ja" / "index.html").read_text("utf-8")
    assert "furo" in (site / "licences.txt").read_text("utf-8")
    page = (site / "index.html").read_text("utf-8")
    for name in ("tutorial/quick-start", "reference/measurements", "licences"):
        assert f'class="reference internal" href="{name}.html"' in page
    # Nothing tells which machine made it, and no page of the source is shipped.
    assert not [path for path in site.rglob("*") if path.suffix in {".md", ".map", ".pickle"}]
    assert [path.name for path in site.rglob("*.html") if str(ROOT) in path.read_text("utf-8")] == []


def test_every_link_of_the_built_guide_leads_somewhere(site: Path) -> None:
    pages = {path: path.read_text("utf-8") for path in site.rglob("*.html")}
    missing = []
    for page, text in pages.items():
        for target in re.findall(r'<a\b[^>]*?\bhref="([^"]+)"', text):
            name, _, heading = unquote(target).partition("#")
            there = (page.parent / name).resolve() if name else page
            known = there.exists() and (
                not heading or there not in pages or f'id="{heading}"' in pages[there]
            )
            if not re.match(r"\w+:", target) and not known:
                missing.append(f"{page.relative_to(site)}: {target}")
    assert missing == []


@pytest.mark.parametrize(
    "loads",
    [
        '<script src="https://host.example/a.js"></script>',
        '<img alt="" src="//host.example/a.png">',
        '<link rel="stylesheet" href="http://host.example/a.css" />',
        '<style>@import "https://host.example/a.css";</style>',
        '<p style="background: url(https://host.example/a.png)">',
        '<img src="missing.png">',
    ],
)
def test_a_page_that_loads_from_elsewhere_is_found(tmp_path: Path, loads: str) -> None:
    (tmp_path / "here.png").touch()
    (tmp_path / "page.html").write_text(
        f'<a href="https://host.example">a link is no load</a><img src="here.png">{loads}', "utf-8"
    )
    assert len(builder().loaded_from_elsewhere(tmp_path)) == 1


def test_each_picture_of_a_measure_is_one_of_its_own_and_shows_the_page_behind_it() -> None:
    paths = sorted((DOCS / "pictures" / "measures").glob("*.png"))
    assert len(paths) > 20
    assert len({path.read_bytes() for path in paths}) == len(paths)
    opaque = [path.name for path in paths if Image.open(path).convert("RGBA").getchannel("A").getextrema()[0]]
    assert opaque == [], "a white block on a dark page"


def test_pages_are_found_by_words_of_the_trade_join_their_lines_and_open_their_pictures(site: Path) -> None:
    page = (site / "explanation" / "contact-pressure.html").read_text("utf-8")
    assert re.search(r'<meta content="pressure [^"]*" name="keywords"', page)
    assert "TRADE_WORDS" in (site / "_static" / "language_data.js").read_text("utf-8")
    first = (site / "tutorial" / "quick-start.html").read_text("utf-8")
    assert re.search(r'<a class="[^"]*" href="(../_images/first-scan\.png)"><img[^>]* src="\1"', first)
    japanese = (site / "ja" / "screens.html").read_text("utf-8")
    for words in re.findall("<p>(.*?)</p>", japanese, re.DOTALL):
        parted = "[ぁ-んァ-ヶ一-龥。、]\n[ぁ-んァ-ヶ一-龥]|[。、] [ぁ-んァ-ヶ一-龥]"
        assert not re.search(parted, re.sub("<[^>]*>", "", words)), words
    assert 'href="../how-to/troubleshooting.html">困ったとき' in japanese


def test_every_page_with_words_of_the_trade_is_there() -> None:
    words = re.findall(r'^  "([\w/-]+)": "(.*)",$', (DOCS / "search.js").read_text("utf-8"), re.MULTILINE)
    assert len(words) > 10
    assert [page for page, _ in words if not (DOCS / f"{page}.md").is_file()] == []


def test_one_page_tells_what_busk_writes_and_removes_no_more_than_that() -> None:
    removing = {page.name: page.read_text("utf-8") for page in PAGES if "rm -rf" in page.read_text("utf-8")}
    assert list(removing) == ["install.md"]
    written = re.findall(r"^\| `(~/[^`]+)`", removing["install.md"], re.MULTILINE)
    assert re.search(r"rm -rf (.*)", removing["install.md"])[1].split() == written
    assert all("Busk" in place or "QtProject" in place for place in written)
