"""The fenced blocks of the documents, and how each is run: by the tests, and to make the pictures of the documents."""

from __future__ import annotations

import ast
import contextlib
import io
import os
import re
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

import sinew

ROOT = Path(__file__).resolve().parents[2]


def pages() -> list[str]:
    """All pages of the site but those it makes of headers and docstrings."""
    patterns = re.search(r"^include_patterns = (.*)$", (ROOT / "docs" / "site" / "conf.py").read_text(), re.MULTILINE)
    assert patterns
    found = {str(path.relative_to(ROOT)) for pattern in ast.literal_eval(patterns.group(1)) for path in ROOT.glob(pattern)}
    return sorted(page for page in found if not page.startswith(("docs/api/", "build/", "out/")))


@dataclass
class Block:
    """A fenced block of a page: its language, the words behind it that readers do not see, and where it stands.

    `file=NAME` is written there, `add=NAME` goes to the end of that file, `in=SCENE` is a part of that scene, `fails` must end with an error, whose text counts as its output,
    `no-run` is not run: it installs, measures or serves."""

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
    path = folder / (block.word("file") or block.word("add") or "scene_of_this_page.yaml")
    path.parent.mkdir(parents=True, exist_ok=True)
    text = path.read_text() + block.text if block.word("add") else block.text
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


def run(page: str, program: Path, folder: Path) -> None:
    """Runs all blocks of a page, one after the other, in an empty folder (the working directory) that then looks like the repository."""
    (folder / "build" / "release").mkdir(parents=True)
    (folder / "build" / "release" / "sinew").symlink_to(program)
    shutil.copytree(ROOT / "examples", folder / "examples")
    shutil.copytree(ROOT / "python" / "examples", folder / "python" / "examples")
    (folder / "meshes").symlink_to(folder / "examples" / "meshes")  # scenes "beside the examples"
    environment = {**os.environ, "PATH": f"{Path(sys.executable).parent}:{program.parent}:{os.environ['PATH']}"}
    names: dict[str, object] = {"__name__": "__main__"}
    output: str | None = None
    for block in blocks(page):
        where = f"{page}:{block.line}"
        if "no-run" in block.words:
            output = None
        elif block.language == "yaml":
            try:
                run_scene(block, folder)
            except Exception as error:
                raise AssertionError(where) from error
        elif block.language == "python":
            said = io.StringIO()
            with contextlib.redirect_stdout(said):
                exec(compile("\n" * block.line + block.text, page, "exec"), names)
            output = said.getvalue()
        elif block.language == "sh":
            command = ["bash", "-euo", "pipefail", "-c", block.text]
            done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=folder, env=environment)
            assert (done.returncode != 0) == ("fails" in block.words), f"{where}\n{done.stdout}{done.stderr}"
            output = done.stderr if "fails" in block.words else done.stdout
        elif block.language == "text":
            assert output is not None, f"{where}: nothing above it was run that could have said this"
            expect_output(block.text, output)
        else:
            assert block.language == "math", f"{where}: no way to run a block of '{block.language}'"
