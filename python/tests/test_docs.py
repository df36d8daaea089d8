"""Everything public is told of, types are right, and what the documents show runs."""

from __future__ import annotations

import ast
import contextlib
import inspect
import io
import os
import re
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
import yaml
from conftest import ROOT

import sinew
from sinew import convert, envs, errors, mesh, plot, running

# Blocks that the tests do not run, by page: they install, build, measure for minutes, serve a page, or need what is not here.
NOT_RUN: dict[str, int] = {}
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


def pages() -> list[str]:
    """All pages of the site but those it makes of headers and docstrings."""
    patterns = re.search(r"^include_patterns = (.*)$", (ROOT / "docs" / "site" / "conf.py").read_text(), re.MULTILINE)
    assert patterns
    found = {str(path.relative_to(ROOT)) for pattern in ast.literal_eval(patterns.group(1)) for path in ROOT.glob(pattern)}
    return sorted(page for page in found if not page.startswith(("docs/api/", "build/", "out/")))


@dataclass
class Block:
    """A fenced block of a page: its language, the words behind it that readers do not see, and where it stands.

    `file=NAME` is written there, `in=SCENE` is a part of that scene, `no-run` is not run: it installs, measures or serves."""

    language: str
    words: list[str]
    line: int
    text: str

    def word(self, name: str) -> str | None:
        return next((word.removeprefix(f"{name}=") for word in self.words if word.startswith(f"{name}=")), None)


def blocks(page: str) -> list[Block]:
    text = (ROOT / page).read_text()
    found = []
    for part in re.finditer(r"^( *)```(.*)\n((?:.*\n)*?)\1```$", text, re.MULTILINE):
        language, *words = part.group(2).split() or [""]
        content = "".join(line.removeprefix(part.group(1)) for line in part.group(3).splitlines(keepends=True))
        found.append(Block(language, words, text[: part.start()].count("\n") + 1, content))
    assert text.count("```") == 2 * len(found), f"{page}: a block without its end"
    return found


def merged(below: Any, above: Any) -> Any:
    """A tree with what another one says in place of its own."""
    if not (isinstance(below, dict) and isinstance(above, dict)):
        return above
    return {**below, **{key: merged(below.get(key), value) for key, value in above.items()}}


def run_scene(block: Block, folder: Path) -> None:
    """Builds a scene and makes two steps of it, or finds its modes."""
    path = folder / (block.word("file") or "scene_of_this_page.yaml")
    path.parent.mkdir(parents=True, exist_ok=True)
    text = block.text
    if base := block.word("in"):
        path = (folder / base).with_name("part_of_this_page.yaml")
        text = yaml.safe_dump(merged(yaml.safe_load((folder / base).read_text()), yaml.safe_load(text)))
    path.write_text(text)
    model = sinew.build(path)
    if "analysis: modal" in text:
        sinew.simulate(model, progress=False)
        return
    state = model.initial_state()
    for _ in range(2):
        report = sinew.step(model, None, state)
        assert report.accepted, report.meaning


def expect_output(expected: str, output: str) -> None:
    """Every line in its order; `...` stands for anything, on a line of its own for any number of lines."""
    pattern = "".join(
        r"(?:.*\n)*?" if line.strip() == "..." else r"\s*" + r"\s+".join(map(re.escape, line.split())).replace(r"\.\.\.", ".*?") + r"\s*\n"
        for line in expected.splitlines()
        if line.strip()
    )
    said = "".join(f"{line}\n" for line in output.splitlines() if line.strip())
    assert re.search(pattern, said), f"expected\n{expected}\nfound\n{said}"


PAGES = {page: blocks(page) for page in pages()}


@pytest.mark.parametrize("page", [page for page, found in PAGES.items() if any(block.language != "math" for block in found)])
def test_every_block_of_the_documents_runs(page: str, program: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("matplotlib").use("Agg")
    (tmp_path / "build" / "release").mkdir(parents=True)
    (tmp_path / "build" / "release" / "sinew").symlink_to(Path(program).resolve())
    shutil.copytree(ROOT / "examples", tmp_path / "examples")
    shutil.copytree(ROOT / "python" / "examples", tmp_path / "python" / "examples")
    (tmp_path / "meshes").symlink_to(tmp_path / "examples" / "meshes")  # scenes "beside the examples"
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PATH", f"{Path(sys.executable).parent}:{Path(program).parent}:{os.environ['PATH']}")
    names: dict[str, object] = {"__name__": "__main__"}
    output: str | None = None
    for block in PAGES[page]:
        where = f"{page}:{block.line}"
        if "no-run" in block.words:
            output = None
        elif block.language == "yaml":
            try:
                run_scene(block, tmp_path)
            except Exception as error:
                raise AssertionError(where) from error
        elif block.language == "python":
            said = io.StringIO()
            with contextlib.redirect_stdout(said):
                exec(compile("\n" * block.line + block.text, page, "exec"), names)
            output = said.getvalue()
        elif block.language == "sh":
            done = subprocess.run(["bash", "-euo", "pipefail", "-c", block.text], capture_output=True, text=True, check=False)
            assert done.returncode == 0, f"{where}\n{done.stdout}{done.stderr}"
            output = done.stdout
        elif block.language == "text":
            assert output is not None, f"{where}: nothing above it was run that could have said this"
            expect_output(block.text, output)
        else:
            assert block.language == "math", f"{where}: no way to run a block of '{block.language}'"


def test_few_blocks_are_not_run() -> None:
    left_out = {page: sum("no-run" in block.words for block in found) for page, found in PAGES.items()}
    assert {page: number for page, number in left_out.items() if number} == NOT_RUN


@pytest.mark.parametrize("page", ["README.md", "python/README.md", *(page for page in PAGES if page.startswith("docs/"))])
def test_code_is_fenced(page: str) -> None:
    """What is only indented is not run."""
    text = re.sub(r"^```.*?^```$", "", (ROOT / page).read_text(), flags=re.MULTILINE | re.DOTALL)
    assert not re.findall(r"(?:^|\n)\n {4}\S.*", text)
