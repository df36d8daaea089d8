"""Everything public is told of, types are right, and what the documents show runs."""

from __future__ import annotations

import inspect
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import ROOT

import sinew
from sinew import convert, envs, errors, mesh, plot, running

sys.path.insert(0, str(ROOT / "docs" / "site"))
import blocks  # noqa: E402
import headers  # noqa: E402

# Blocks that the tests do not run, by page: they install, build, measure for minutes, serve a page, or need what is not here.
NOT_RUN = {
    "README.md": 2,
    "bench/README.md": 4,
    "docs/howto/own_mesh.md": 1,
    "docs/page.md": 2,
    "docs/python.md": 1,
    "docs/tutorials/finger.md": 1,
    "docs/tutorials/python.md": 1,
    "docs/validation.md": 1,
    "python/README.md": 1,
    "viewer/README.md": 1,
}
MODULES = [sinew, convert, envs, errors, mesh, plot, running]


def public() -> list[tuple[str, object]]:
    found: dict[str, object] = {}
    for module in MODULES:
        for name, own in vars(module).items():
            if name.startswith("_") or inspect.ismodule(own) or not getattr(own, "__module__", "").startswith("sinew"):
                continue
            found[f"{own.__module__}.{name}"] = own
            if inspect.isclass(own):
                for member, value in vars(own).items():
                    if not member.startswith("_") and (callable(value) or isinstance(value, property)):
                        found[f"{own.__module__}.{name}.{member}"] = value
    return sorted(found.items())


# What overrides says what it says above.
INHERITED = {"begin", "extra", "reward", "reset", "step", "close_extras", "ahead"}


@pytest.mark.parametrize(("name", "own"), public(), ids=lambda own: own if isinstance(own, str) else "")
def test_everything_public_has_a_docstring(name: str, own: object) -> None:
    if name.split(".")[-1] in INHERITED and ".envs." in name:
        return
    assert (inspect.getdoc(own) or "").strip(), name


def test_headers_are_read_as_they_are_written(tmp_path: Path) -> None:
    header = tmp_path / "a.hpp"
    header.write_text(
        "namespace x {\n/// A thing.\nstruct Thing {\n  double a = 0.0, b;  ///< [m] both\n  int c{};  ///< first\n"
        "           ///< and second\n  /// Above.\n  void f(int g) const;\n  int silent;\n};\n"
        "/// Does it,\n/// well.\nint work(const Thing& thing,\n         int more = 3);\n"
        "enum class Kind { one, two };  ///< kinds\n}\n"
    )
    out = tmp_path / "docs.hpp"
    subprocess.run([sys.executable, ROOT / "python" / "engine" / "header_docs.py", out, header], check=True)
    told = dict(
        (line.split()[4], line.split('R"doc(')[1].removesuffix(')doc";'))
        for line in out.read_text().splitlines()
        if line.startswith("inline")
    )
    assert told == {
        "Thing": "A thing.",
        "Thing_a": "[m] both",
        "Thing_b": "[m] both",
        "Thing_c": "first and second",
        "Thing_f": "Above.",
        "work": "Does it, well.",
        "Kind": "kinds",
    }


@pytest.mark.parametrize("folder", sorted((ROOT / "src" / "sinew").iterdir()), ids=lambda folder: folder.name)
def test_what_pages_show_of_headers_is_whole(folder: Path) -> None:
    lexer = pytest.importorskip("pygments.lexers").CppLexer()  # which the site uses, too
    error = pytest.importorskip("pygments.token").Error
    shown = re.findall(r"```cpp\n(.*?)\n```", headers.page(folder), re.DOTALL)
    assert shown
    for code in shown:
        assert "namespace " not in code
        assert not [text for kind, text in lexer.get_tokens(code) if kind is error], code


def test_types_are_strictly_right() -> None:
    pytest.importorskip("mypy")
    told = subprocess.run(
        [sys.executable, "-m", "mypy", "--strict", "--config-file", ROOT / "pyproject.toml", "-p", "sinew"],
        capture_output=True,
        text=True,
        check=False,
        cwd=ROOT,
    )
    assert told.returncode == 0, told.stdout
    examples = sorted((ROOT / "python" / "examples").glob("*.py"))
    assert examples
    told = subprocess.run(
        [sys.executable, "-m", "mypy", "--strict", "--config-file", ROOT / "pyproject.toml", *examples],
        capture_output=True,
        text=True,
        check=False,
        cwd=ROOT,
    )
    assert told.returncode == 0, told.stdout


def test_every_status_is_on_the_page_of_troubles() -> None:
    header = (ROOT / "src" / "sinew" / "sim" / "status.hpp").read_text()
    listed = re.search(r"enum class Status \{(.*?)\};", header, re.DOTALL)
    assert listed
    statuses = re.findall(r"^  (\w+),", listed.group(1), re.MULTILINE)
    told = re.findall(r"^## `(\w+)`$", (ROOT / "docs" / "howto" / "troubleshooting.md").read_text(), re.MULTILINE)
    assert len(statuses) >= 9
    assert told == statuses


def test_theory_names_what_is_in_the_code() -> None:
    text = (ROOT / "docs" / "theory.md").read_text()
    named = re.findall(r"`(\w+/\w+)`((?:,?\s+`\w+`)+)", text)
    assert len(named) > 30
    for file, names in named:
        sources = [ROOT / "src" / "sinew" / f"{file}.{end}" for end in ("hpp", "cpp")]
        code = "".join(source.read_text() for source in sources if source.exists())
        assert code, file
        for name in re.findall(r"`(\w+)`", names):
            assert re.search(rf"\b{name}\b", code), f"{file} {name}"


PAGES = {page: blocks.blocks(page) for page in blocks.pages()}


@pytest.mark.parametrize("page", [page for page, found in PAGES.items() if any(block.language != "math" for block in found)])
def test_every_block_of_the_documents_runs(page: str, program: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("matplotlib").use("Agg")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PATH", f"{Path(program).parent}:{os.environ['PATH']}")
    blocks.run(page, Path(program).resolve(), tmp_path)


def test_documents_can_be_followed_in_one_checkout() -> None:
    """What one page writes is not in the way of another."""
    pages: dict[str, set[str]] = {}
    for page, found in [*PAGES.items(), ("scripts/demo", [blocks.Block("sh", [], 1, (ROOT / "scripts" / "demo").read_text())])]:
        for block in found:
            if block.language == "sh":
                for folder in re.findall(r"sinew (?:run|workspace|export)\b.*? -o (\S+)", block.text.replace("\\\n", " ")):
                    pages.setdefault(folder, set()).add(page)
    assert len(pages) > 20
    assert {folder: found for folder, found in pages.items() if len(found) > 1} == {}


def test_few_blocks_are_not_run() -> None:
    left_out = {page: sum("no-run" in block.words for block in found) for page, found in PAGES.items()}
    assert {page: number for page, number in left_out.items() if number} == NOT_RUN


@pytest.mark.parametrize("page", ["README.md", "bench/README.md", "python/README.md", "viewer/README.md", *(page for page in PAGES if page.startswith("docs/"))])
def test_code_is_fenced(page: str) -> None:
    """What is only indented is not run."""
    text = re.sub(r"^```.*?^```$", "", (ROOT / page).read_text(), flags=re.MULTILINE | re.DOTALL)
    assert not re.findall(r"(?:^|\n)\n {4}\S.*", text)
