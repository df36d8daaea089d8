"""The documentation site (scripts/build_docs). Its pages are those of the repository, where they stand, so that links between them work
on the git host as on the site; the pages of the API are made from headers and docstrings, into docs/api."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import Any

import latex2mathml.converter
from docutils import nodes
from sphinx.application import Sphinx

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
exclude_patterns = ["build", "out", "tests"]
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx_copybutton"]

# What README.md does not say: the pages and their order. A pattern stands for all files it matches, which may be none.
CONTENTS = {
    "Tutorials": [f"docs/tutorials/{page}" for page in ("finger", "gripper", "trunk", "rod_robot", "inverse", "contact", "python")],
    "How to": ["docs/howto/own_mesh", "docs/howto/sections_and_step", "docs/howto/reading_forces", "docs/howto/troubleshooting"],
    "Features": ["docs/solids", "docs/rods", "docs/contact", "docs/inverse", "docs/python", "docs/page", "NOTATION", "examples/meshes/README"],
    "Theory": ["docs/theory", "src/sinew/*/README"],
    "Evidence": ["docs/validation*", "examples/paper/README", "examples/*/*/README", "docs/points", "docs/newton", "docs/elements", "bench/README"],
    "API": ["docs/api/python/*", "docs/api/cpp/*"],
    "Project": ["ARCHITECTURE", "CONTRIBUTING", "CHANGELOG", "python/README", "viewer/README"],
}

myst_heading_anchors = 4  # as on the git host
myst_fence_as_directive = {"math"}
highlight_language = "text"
copybutton_exclude = ".linenos, .gp, .go"
autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_preserve_defaults = True

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
    translator.body.append(f'<div class="formula">{text}</div>' if block else text)
    raise nodes.SkipNode


def first_page(app: Sphinx, error: Exception | None) -> None:
    """index.html leads to the first page, which is called as on the git host."""
    if error is None and app.builder.format == "html":
        text = f'<!doctype html><meta charset="utf-8"><title>{project}</title><meta http-equiv="refresh" content="0; url={root_doc}.html">'
        (Path(app.outdir) / "index.html").write_text(text)


def setup(app: Sphinx) -> None:
    api.write(ROOT)
    app.add_html_math_renderer("mathml", (formula, None), (formula, None))
    app.connect("source-read", add_contents)
    app.connect("build-finished", first_page)
