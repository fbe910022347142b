"""How Sphinx makes the user guide of these pages: ``make docs``; with the tag ``ja``, its Japanese part."""

from __future__ import annotations

import re
import sys
from pathlib import Path

from docutils import nodes
from sphinx.application import Sphinx

DOCS = Path(__file__).parent
sys.path.insert(0, str(DOCS.parent))

from app.rendering.palette import DARK, LIGHT, Tokens  # noqa: E402
from core import __version__  # noqa: E402

japanese = tags.has("ja")  # noqa: F821 - Sphinx puts it here

project = "Busk"
version = release = __version__
html_title = f"Busk {__version__} ユーザーガイド" if japanese else f"Busk {__version__}, user guide"
language = "ja" if japanese else "en"
exclude_patterns = [] if japanese else ["ja"]
extensions = ["myst_parser"]
myst_heading_anchors = 4  # a link to a heading reads as on a code host: page.md#words-of-the-heading
myst_url_schemes = {"http": None, "https": None, "page": "{{path}}", "heading": "{{path}}#{{fragment}}"}
nitpicky = True
highlight_language = "text"

html_theme = "furo"
templates_path = [str(DOCS / "_templates")]
# The Japanese part lies in the folder ja of the guide, and shares what is beside it.
shared = "../../_static/" if japanese else ""
html_static_path = (
    []
    if japanese
    else [
        "_static",
        "../resources/icons/program/busk.svg",
        *(f"../resources/fonts/Inter-{name}.ttf" for name in ("Regular", "SemiBold")),
        *(f"../resources/fonts/NotoSansJP-{name}.otf" for name in ("Regular", "Bold")),
        *(f"../resources/fonts/{name}-LICENSE.txt" for name in ("Inter", "NotoSansJP")),
    ]
)
html_css_files = [f"{shared}guide.css"]
html_show_copyright = html_show_sphinx = html_copy_source = html_show_sourcelink = html_use_index = False
html_show_search_summary = False  # it would be fetched, which no browser allows for a file on the disk
html_permalinks_icon = "#"
SEARCH = DOCS / "search.js"
html_search_scorer = str(SEARCH)
TRADE_WORDS = dict(re.findall(r'^  "(\w+)": "(.*)",$', SEARCH.read_text("utf-8"), re.MULTILINE))
"""Pages with the words of the trade that they answer."""


def colours(tokens: Tokens) -> dict[str, str]:
    """Return the colours of the window under the names of the theme."""
    return {
        "color-foreground-primary": tokens.text,
        "color-foreground-secondary": tokens.text_quiet,
        "color-foreground-muted": tokens.text_caption,
        "color-foreground-border": tokens.control,
        "color-background-primary": tokens.panel,
        "color-background-secondary": tokens.app,
        "color-background-hover": tokens.pressed,
        "color-background-hover--transparent": tokens.pressed + "00",
        "color-background-border": tokens.line,
        "color-background-item": tokens.outline,
        "color-brand-primary": tokens.text,
        "color-brand-content": tokens.accent,
        "color-brand-visited": tokens.accent,
        "color-highlight-on-target": tokens.selected,
        "color-inline-code-background": tokens.hover,
        "color-code-background": tokens.hover,
        "color-code-foreground": tokens.text,
        "color-sidebar-item-background--current": tokens.selected,
    }


html_theme_options = {
    "light_css_variables": colours(LIGHT),
    "dark_css_variables": colours(DARK),
    "top_of_page_buttons": ["view"],  # its template leads to the other language
}

OUTSIDE = {"../README.md": "index.md", "../CHANGELOG.md": "changes.md", "../THIRD_PARTY.md": "licences.md"}
"""Pages of the repository that are not of the guide, and what stands for them in it."""


def listed_pages(text: str) -> str:
    """Return a table of contents for what a page lists under its headings: the list is written once."""
    chapters = re.findall(r"^## (.*)\n((?:(?!## ).*\n)*)", text, re.MULTILINE)
    trees = []
    for title, lines in chapters:
        pages = "\n".join(re.findall(r"^- \[.*?\]\((\w+)\.md\)", lines, re.MULTILINE))
        trees.append(f"```{{toctree}}\n:hidden:\n:caption: {title}\n\n{pages}\n```\n")
    return "\n".join(trees)


def as_guide(app: Sphinx, page: str, source: list[str]) -> None:
    """Lead links to where things are in the guide, and give its first page the table of contents."""
    text = source[0]
    for outside, inside in OUTSIDE.items():
        text = text.replace(f"]({outside}", f"]({inside}")
    # From one language to the other: to pages that this run of Sphinx does not know.
    text = re.sub(r"\]\((\.\./\w+|ja/\w+)\.md\)", r"](page:\1.html)", text)
    text = re.sub(r"\]\((\.\./\w+|ja/\w+)\.md#", r"](heading:\1.html#", text)
    # A page that is named by its file is named by its title.
    text = re.sub(r"\[\w+\.md\](?=\(\w+\.md\))", "[]", text)
    source[0] = f"{text}\n{listed_pages(text)}" if page == "index" else text


def add_trade_words(app: Sphinx, page: nodes.document) -> None:
    """Let a page be found by the words of the trade that it answers, though they may not stand in it."""
    words = "" if japanese else TRADE_WORDS.get(app.env.docname, "")
    if words:
        page.insert(0, nodes.meta(name="keywords", content=words))


WIDE = "[\u3000-\u30ff\u3400-\u9fff\uff00-\uffef]"
"""A letter or a mark of Japanese, which no blank parts from the next."""

NO_BLANK = re.compile(f"{WIDE}\n{WIDE}|[。、：）」] {WIDE}")
"""A break of a line in the source; a blank that ends bold words after a mark. A browser shows both."""


def join_japanese(app: Sphinx, page: nodes.document) -> None:
    """Drop what would part Japanese letters that belong together."""
    for paragraph in page.findall(nodes.paragraph):
        whole, at = paragraph.astext(), 0
        for text in list(paragraph.findall(nodes.Text)):
            places = enumerate(text, start=at)
            kept = [
                each for place, each in places if not NO_BLANK.fullmatch(whole[max(place - 1, 0) : place + 2])
            ]
            at += len(text)
            text.parent.replace(text, nodes.Text("".join(kept)))


def caption_pictures(app: Sphinx, page: nodes.document) -> None:
    """Let what a picture that stands by itself shows be read under it too, and a click show its full size."""
    for number, picture in enumerate(list(page.findall(nodes.image)), start=1):
        around = picture.parent
        alone = isinstance(around, nodes.paragraph) and len(around) == 1
        if alone and picture.get("alt") and not isinstance(around.parent, nodes.entry):
            caption = nodes.caption("", picture["alt"])
            picture["scale"] = 100  # Sphinx leads what has a scale to the picture itself
            around.replace_self(nodes.figure("", picture, caption, ids=[f"picture-{number}"]))


def other_language(app: Sphinx, page: str, template: str, context: dict[str, object], tree: object) -> None:
    """Tell the template where the page, or the first one, stands in the other language."""
    there = DOCS if japanese else DOCS / "ja"
    name = page if (there / f"{page}.md").is_file() else "index"
    context["shared"] = shared
    # What the Japanese first page names of the English ones stands at the side of every page.
    first = (DOCS / "ja" / "index.md").read_text("utf-8") if japanese else ""
    context["english_pages"] = [link[::-1] for link in re.findall(r"\[([^]]+)\]\(\.\./(\w+)\.md\)", first)]
    context["other_language"] = f"../{name}.html" if japanese else f"ja/{name}.html"


def setup(app: Sphinx) -> None:
    """Ask to be called."""
    app.connect("source-read", as_guide)
    app.connect("doctree-read", add_trade_words)
    app.connect("doctree-read", join_japanese)
    app.connect("doctree-read", caption_pictures)
    app.connect("html-page-context", other_language)
