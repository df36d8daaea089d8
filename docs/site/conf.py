"""The documentation site (scripts/build_docs). Its pages are those of the repository, where they stand, so that links between them work
on the git host as on the site; the pages of the API are made from headers and docstrings, into docs/api."""

from __future__ import annotations

import os
import re
import sys
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import latex2mathml.converter
from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util import logging

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path.insert(0, str(HERE))
if "SINEW_PACKAGES" in os.environ:  # where the package sinew is installed
    sys.path.append(os.environ["SINEW_PACKAGES"])

import api  # noqa: E402

project = "Sinew"
html_title = "Sinew"
root_doc = "README"
include_patterns = ["*.md", "docs/*.md", "docs/**/*.md", "src/sinew/*/README.md", "examples/**/README.md", "*/README.md"]
exclude_patterns = ["build", "out", "tests", ".*", "**/.*", "**/node_modules"]
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx_copybutton"]

# What README.md does not say: the pages and their order. A pattern stands for all files it matches, which may be none.
CONTENTS = {
    "Tutorials": [f"docs/tutorials/{page}" for page in ("finger", "gripper", "trunk", "rod_robot", "inverse", "contact", "python")],
    "How to": ["docs/howto/own_mesh", "docs/howto/sections_and_step", "docs/howto/reading_forces", "docs/howto/troubleshooting"],
    "Features": ["docs/solids", "docs/rods", "docs/contact", "docs/inverse", "docs/warnings", "docs/python", "docs/page", "NOTATION", "examples/meshes/README"],
    "Theory": ["docs/theory", "src/sinew/*/README"],
    "Evidence": ["docs/validation*", "examples/paper/README*", "examples/validation/README*", "examples/*/*/README", "docs/points", "docs/newton", "docs/elements", "bench/README"],
    "Python API": ["docs/api/python/*"],
    "C++ API": ["docs/api/cpp/*"],
    "Project": ["ARCHITECTURE", "CONTRIBUTING", "CHANGELOG", "python/README", "viewer/README"],
}

myst_heading_anchors = 4  # as on the git host
myst_fence_as_directive = {"math"}
highlight_language = "text"
copybutton_exclude = ".linenos, .gp, .go"
autodoc_inherit_docstrings = False
autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_preserve_defaults = True
autodoc_type_aliases = {"npt.ArrayLike": "numpy.typing.ArrayLike"}
nitpick_ignore_regex = [("py:.*", r"(?!sinew\.).*|sinew\.parts\.P")]  # names of other packages; nothing is fetched to link to them

html_theme = "furo"
html_static_path = ["site.css"]
html_css_files = ["site.css"]
html_show_copyright = html_show_sphinx = html_copy_source = False
html_math_renderer = "mathml"


def add_contents(app: Sphinx, page: str, source: list[str]) -> None:
    """The list of pages, behind the text of the first one."""
    if page != root_doc:
        return
    for caption, patterns in CONTENTS.items():
        pages = [pattern for pattern in patterns if "*" not in pattern or any(ROOT.glob(f"{pattern}.md"))]
        source[0] += "\n\n```{toctree}\n:hidden:\n:glob:\n:caption: " + caption + "\n\n" + "\n".join(pages) + "\n```"


def formula(translator: Any, node: nodes.math | nodes.math_block) -> None:
    """TeX as MathML, which browsers draw without a script or fonts from elsewhere."""
    block = isinstance(node, nodes.math_block)
    text = latex2mathml.converter.convert(node.astext(), display="block" if block else "inline")
    if "\\" in text or node.astext().count("{") != node.astext().count("}"):
        logging.getLogger(__name__).warning("a formula that is none: %s", node.astext(), location=node)
    translator.body.append(f'<div class="formula">{text}</div>' if block else text)
    raise nodes.SkipNode


def plain_docstring(app: Sphinx, what: str, name: str, value: object, options: Any, lines: list[str]) -> None:
    """Docstrings are plain text in which lines `name: meaning` tell of arguments: a list, and code between backticks."""
    said: list[str] = []
    in_list = False
    for line in lines:
        text = re.sub(r"[*|\\]|(?<=\w)_(?=\W|$)", r"\\\g<0>", line.strip())
        text = re.sub(r"`+([^`]+)`+", r"``\1``", text)
        argument = re.match(r"(\w+): (.*)", text)
        if argument:
            said += [*([] if in_list else [""]), f"* **{argument.group(1)}**: {argument.group(2)}"]
        elif in_list and text:
            said[-1] += f" {text}"
        else:
            said.append(text)
        in_list = bool(text) and (in_list or argument is not None)
    lines[:] = said


def plain_signature(app: Sphinx, what: str, name: str, value: object, options: Any, signature: str, returns: str) -> tuple[str, str]:
    """Types by the names that people know."""
    names = {r"TypeAliasForwardRef\('([\w.]+)'\)": r"\1", r"ndarray\[tuple\[Any, \.\.\.\], dtype\[\w+\]\]": "ndarray",
             r"sinew\._engine\.(?!Contact\b)": "sinew."}
    for pattern, known in names.items():
        signature, returns = (re.sub(pattern, known, text) if text else text for text in (signature, returns))
    return signature, returns


def outside_links(app: Sphinx, doctree: nodes.document, page: str) -> None:
    """Nothing is fetched, so of links that lead elsewhere only the form is looked at; build/links.txt lists them."""
    for link in doctree.findall(nodes.reference):
        address = link.get("refuri", "")
        parts = urlsplit(address)
        if not parts.scheme:
            continue
        if parts.scheme != "https" or "." not in parts.netloc or re.search(r"[\s<>]", address):
            logging.getLogger(__name__).warning("a link in bad form: %s", address, location=link)
        with (ROOT / "build" / "links.txt").open("a") as listed:
            listed.write(f"{page}: {address}\n")


def first_page(app: Sphinx, error: Exception | None) -> None:
    """index.html leads to the first page, which is called as on the git host."""
    if error is None and app.builder.format == "html":
        text = f'<!doctype html><meta charset="utf-8"><title>{project}</title><meta http-equiv="refresh" content="0; url={root_doc}.html">'
        (Path(app.outdir) / "index.html").write_text(text)


def setup(app: Sphinx) -> None:
    api.write(ROOT)
    app.add_html_math_renderer("mathml", (formula, None), (formula, None))
    app.connect("source-read", add_contents)
    app.connect("autodoc-process-docstring", plain_docstring)
    app.connect("autodoc-process-signature", plain_signature)
    (ROOT / "build").mkdir(exist_ok=True)
    (ROOT / "build" / "links.txt").write_text("")
    app.connect("doctree-resolved", outside_links)
    app.connect("build-finished", first_page)
