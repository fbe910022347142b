"""Sphinx configuration of the user guide (``make docs``); with the tag ``ja``, of its Japanese part."""

from __future__ import annotations

import re
import sys
from pathlib import Path

from docutils import nodes
from sphinx.application import Sphinx

DOCS = Path(__file__).parent
sys.path[:0] = [str(DOCS.parent), str(DOCS)]

from generated import with_generated_parts  # noqa: E402

from app.rendering.palette import DARK, LIGHT, Tokens  # noqa: E402
from core import __version__  # noqa: E402

japanese = tags.has("ja")  # noqa: F821 - defined by Sphinx

project = "Busk"
version = release = __version__
html_title = f"Busk {__version__} ユーザーガイド" if japanese else f"Busk {__version__}, user guide"
language = "ja" if japanese else "en"
exclude_patterns = [] if japanese else ["ja"]
extensions = ["myst_parser", "sphinx.ext.autodoc"]
myst_heading_anchors = 4  # as on a code host: page.md#words-of-the-heading
myst_url_schemes = {"http": None, "https": None, "page": "{{path}}", "heading": "{{path}}#{{fragment}}"}
nitpicky = True
nitpick_ignore_regex = [("py:.*", ".*")]  # types in signatures have no pages
add_module_names = False
autodoc_typehints_format = "short"
autodoc_preserve_defaults = True
autodoc_type_aliases = {name: name for name in ("Points", "Floats", "Progress", "Measures")}
python_use_unqualified_type_names = True
highlight_language = "text"

html_theme = "furo"
templates_path = [str(DOCS / "_templates")]
# The Japanese part is the folder ja of the guide and shares the static files of the English one.
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
html_show_search_summary = False  # browsers do not fetch it from a local file
html_permalinks_icon = "#"
SEARCH = DOCS / "search.js"
html_search_scorer = str(SEARCH)
TRADE_WORDS = dict(re.findall(r'^  "([\w/-]+)": "(.*)",$', SEARCH.read_text("utf-8"), re.MULTILINE))
"""Search terms of the trade by page."""


def colours(tokens: Tokens) -> dict[str, str]:
    """Return the colours of the window by the names of the theme."""
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
    "top_of_page_buttons": ["view"],  # its template links the other language
}

OUTSIDE = {"README": "index", "CHANGELOG": "changes", "THIRD_PARTY": "licences"}
"""Pages of the repository outside the guide, and the pages of the guide in their place."""

JAPANESE = {"index": "index", "tutorial/quick-start": "quick-start", "reference/screens": "screens"}
"""Pages that exist in Japanese, and their names there."""


def listed_pages(text: str) -> str:
    """Return tables of contents for the pages that are listed under the headings of a page."""
    chapters = re.findall(r"^## (.*)\n((?:(?!## ).*\n)*)", text, re.MULTILINE)
    trees = []
    for title, lines in chapters:
        pages = "\n".join(re.findall(r"^- \[.*?\]\(([\w/-]+)\.md\)", lines, re.MULTILINE))
        trees.append(f"```{{toctree}}\n:hidden:\n:caption: {title}\n\n{pages}\n```\n")
    return "\n".join(trees)


def guide_link(page: str, words: str, target: str) -> str:
    """Return a link of a page as it is in the guide: to its pages, to the other language, or words alone."""
    name, _, heading = target.partition("#")
    there = (DOCS / "ja" / page if japanese else DOCS / page).parent.joinpath(name).resolve()
    if not there.is_relative_to(DOCS):
        inside = OUTSIDE.get(there.stem)
        up = "../" * page.count("/")
        return f"[{words}]({up}{inside}.md)" if inside else f"`{there.relative_to(DOCS.parent)}`"
    if there.is_relative_to(DOCS / "ja") == japanese:
        return f"[{words}]({target})"
    # A page of the other language, which this run of Sphinx does not know.
    address = f"{name.removesuffix('.md')}.html"
    return f"[{words}](heading:{address}#{heading})" if heading else f"[{words}](page:{address})"


def as_guide(app: Sphinx, page: str, source: list[str]) -> None:
    """Put generated parts into a page, adapt its links, and give the first page the table of contents."""
    text = with_generated_parts(source[0])
    text = re.sub(
        r"(?<!!)\[([^]]*)\]\(([^)\s:#]+\.md(?:#[^)\s]*)?)\)",
        lambda link: guide_link(page, link[1], link[2]),
        text,
    )
    source[0] = f"{text}\n{listed_pages(text)}" if page == "index" else text


def add_trade_words(app: Sphinx, page: nodes.document) -> None:
    """Add search terms of the trade to a page as keywords."""
    words = "" if japanese else TRADE_WORDS.get(app.env.docname, "")
    if words:
        page.insert(0, nodes.meta(name="keywords", content=words))


WIDE = "[\u3000-\u30ff\u3400-\u9fff\uff00-\uffef]"
"""A Japanese letter or punctuation mark."""

NO_BLANK = re.compile(f"{WIDE}\n{WIDE}|[。、：）」] {WIDE}")
"""A line break of the source, or a space that ends emphasis after punctuation; browsers show both."""


def join_japanese(app: Sphinx, page: nodes.document) -> None:
    """Remove line breaks and spaces between Japanese letters."""
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
    """Give pictures in paragraphs of their own a caption, and link them to their full size."""
    for number, picture in enumerate(list(page.findall(nodes.image)), start=1):
        around = picture.parent
        alone = isinstance(around, nodes.paragraph) and len(around) == 1
        if alone and picture.get("alt") and not isinstance(around.parent, nodes.entry):
            caption = nodes.caption("", picture["alt"])
            picture["scale"] = 100  # Sphinx links scaled pictures to their file
            around.replace_self(nodes.figure("", picture, caption, ids=[f"picture-{number}"]))


def other_language(app: Sphinx, page: str, template: str, context: dict[str, object], tree: object) -> None:
    """Give the template the address of the page, or of the first one, in the other language."""
    context["shared"] = shared
    # The English pages that the Japanese first page names are at the side of every page.
    first = (DOCS / "ja" / "index.md").read_text("utf-8") if japanese else ""
    context["english_pages"] = [
        link[::-1] for link in re.findall(r"\[([^]]+)\]\(\.\./([\w/-]+)\.md\)", first)
    ]
    english = {name: each for each, name in JAPANESE.items()}
    there = f"../{english.get(page, 'index')}" if japanese else f"ja/{JAPANESE.get(page, 'index')}"
    context["other_language"] = f"{'../' * page.count('/')}{there}.html"


def plain_signature(app: Sphinx, *about: object) -> tuple[str, str]:
    """Return signature and result of a function with aliases of types by their names alone."""
    alias = r"TypeAliasForwardRef\('(\w+)'\)"
    signature, result = (re.sub(alias, r"\1", str(each or "")) for each in about[-2:])
    return signature, result


def setup(app: Sphinx) -> None:
    """Connect the functions above to the steps of a build."""
    app.connect("source-read", as_guide)
    app.connect("doctree-read", add_trade_words)
    app.connect("doctree-read", join_japanese)
    app.connect("doctree-read", caption_pictures)
    app.connect("html-page-context", other_language)
    app.connect("autodoc-process-signature", plain_signature)
