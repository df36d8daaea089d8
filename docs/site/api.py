"""Writes the pages of the API: of C++ from the headers of src/sinew (headers.py), of Python a list of what the package shows."""

from __future__ import annotations

import importlib.util
import inspect
from pathlib import Path

import headers
from sphinx.util import logging

PYTHON = {
    "sinew": "What the package shows: build, step, run",
    "sinew.scene": "Scenes, with the keys of scene files",
    "sinew.plot": "Pictures",
    "sinew.convert": "Other formats",
    "sinew.envs": "Environments for learning",
}


def shown(name: str) -> list[tuple[str, object]]:
    """Names of a module and what they mean, in its order; of the package all but those of scenes, which have a page of their own."""
    module = importlib.import_module(name)
    names = getattr(module, "__all__", None) or [own for own, value in vars(module).items() if getattr(value, "__module__", "") == name]
    found = [(own, getattr(module, own)) for own in names if not own.startswith("_")]
    return [(own, value) for own, value in found if name != "sinew" or getattr(value, "__module__", "") != "sinew.scene"]


def python_page(name: str, title: str) -> str:
    parts = [f"# {name}", title + "."]
    for own, value in shown(name):
        kind = "class" if inspect.isclass(value) else "function" if callable(value) else "data"
        options = "\n   :members:" if kind == "class" else ""
        if own == "Scene":
            options += "\n   :inherited-members:"
        if inspect.isclass(value) and issubclass(value, Exception):
            kind = "exception"
        renamed = inspect.isclass(value) and value.__name__ != own
        where = f"{value.__module__}.{value.__name__}" if renamed else f"{name}.{own}"
        parts += [f"## {own}", f"```{{eval-rst}}\n.. auto{kind}:: {where}{options}\n```"]
    return "\n\n".join(parts) + "\n"


def write(root: Path) -> None:
    """All pages, below docs/api; those that are there already are written only if they changed."""
    pages = {f"cpp/{folder.name}.md": headers.page(folder) for folder in sorted((root / "src" / "sinew").iterdir())}
    if importlib.util.find_spec("sinew"):
        pages |= {f"python/{name}.md": python_page(name, title) for name, title in PYTHON.items()}
    else:
        logging.getLogger(__name__).warning("the package sinew is not installed: no pages of its API")
    for name, text in pages.items():
        path = root / "docs" / "api" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if not path.exists() or path.read_text(encoding="utf-8") != text:
            path.write_text(text, encoding="utf-8")
