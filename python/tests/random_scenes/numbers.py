"""Every number of a scene made absurd: `sinew check` answers soon, and no run ends but by a documented exit code.

    python -m random_scenes.numbers --program build/release/sinew SCENE ...    (in python/tests)

Each number of each scene is set to 0, its negative, 1e-300, 1e300, nan, inf and 1e15 in turn. `check` has 2 s of
processor time; what it calls sound is run for a while, and its signals are looked at for numbers that are not finite.
"""

from __future__ import annotations

import argparse
import concurrent.futures
import math
import os
import re
import resource
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import yaml

from .scene import ROOT

NUMBER = re.compile(r"([-+]?\d+(?:\.\d*)?(?:[eE][-+]?\d+)?)(?:\s+[A-Za-z].*)?")
ABSURD = ["0", "-", "1e-300", "1e300", ".nan", ".inf", "1e15"]
CHECK_S, RUN_S = 2, 10
CODES = {0, 2, 3, 4, 124, 130}


def numbers(tree: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """Where a tree has numbers, with units or without."""
    if isinstance(tree, dict):
        for key, value in tree.items():
            yield from numbers(value, (*path, key))
    elif isinstance(tree, list):
        for i, value in enumerate(tree):
            yield from numbers(value, (*path, i))
    elif not isinstance(tree, bool) and (isinstance(tree, int | float) or (isinstance(tree, str) and NUMBER.fullmatch(tree))):
        yield path


def changed(tree: Any, path: tuple[Any, ...], absurd: str) -> Any:
    """A tree with another number at one place; its unit stays."""
    if not path:
        number, _, unit = str(tree).partition(" ")
        text = str(-float(number)) if absurd == "-" else absurd
        return f"{text} {unit}" if unit else yaml.safe_load(text) if absurd in (".nan", ".inf") else float(text)
    if isinstance(tree, dict):
        return {key: changed(value, path[1:], absurd) if key == path[0] else value for key, value in tree.items()}
    return [changed(value, path[1:], absurd) if i == path[0] else value for i, value in enumerate(tree)]


def limit_processor(seconds: int) -> None:
    resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 1))
    resource.setrlimit(resource.RLIMIT_AS, (8 << 30, 8 << 30))


def attempt(scene: Path, path: tuple[Any, ...], absurd: str, program: str) -> tuple[str, str]:
    """How it ended, and what is wrong with that."""
    tree = changed(yaml.safe_load(scene.read_text()), path, absurd)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for beside in scene.parent.iterdir():
            if beside != scene:
                (folder / beside.name).symlink_to(beside)
        file = folder / "scene.yaml"
        file.unlink(missing_ok=True)
        file.write_text(yaml.safe_dump(tree, sort_keys=False))

        def ends(seconds: int, *arguments: str) -> subprocess.CompletedProcess[str]:
            command = ["timeout", "-s", "TERM", str(30), program, *arguments]
            return subprocess.run(command, check=False, cwd=folder, capture_output=True, text=True,
                                  preexec_fn=lambda: limit_processor(seconds))  # noqa: PLW1509

        check = ends(CHECK_S, "check", "scene.yaml")
        if check.returncode not in (0, 2):
            return "check", f"check ends with {check.returncode}: {check.stderr[-200:]}"
        if check.returncode == 2:
            return "refused", "" if "\n    " in check.stderr else f"no remedy: {check.stderr[-200:]}"
        run = subprocess.run(["timeout", "-s", "TERM", str(RUN_S), program, "run", "scene.yaml", "-o", "out", "-q", "--threads", "1"],
                             check=False, cwd=folder, capture_output=True, text=True)
        if run.returncode not in CODES:
            return "run", f"run ends with {run.returncode}: {run.stderr[-200:]}"
        signals = folder / "out" / "signals.csv"
        if signals.exists():
            for row in signals.read_text().splitlines()[1:]:
                if any(not math.isfinite(float(cell)) for cell in row.split(",") if re.fullmatch(r"[-+\d.eE]+|-?nan|-?inf", cell)):
                    return "run", f"not finite: {row[:200]}"
        return f"exit code {run.returncode}", ""


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="*", type=Path, default=sorted((ROOT / "examples").glob("*.yaml")))
    parser.add_argument("--program", default=str(ROOT / "build/release/sinew"))
    arguments = parser.parse_args()
    program = str(Path(arguments.program).resolve())
    tries = [(scene.resolve(), path, absurd) for scene in arguments.scenes
             for path in numbers(yaml.safe_load(scene.read_text())) for absurd in ABSURD]
    ends: Counter[str] = Counter()
    wrong = 0
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for (scene, path, absurd), (end, text) in zip(tries, pool.map(lambda t: attempt(*t, program), tries)):
            ends[end] += 1
            wrong += bool(text)
            if text:
                print(f"{scene.name} {'.'.join(map(str, path))} = {absurd}: {' '.join(text.split())}", flush=True)
    for end, count in sorted(ends.items()):
        print(f"{end:20} {count}")
    print(f"{wrong} of {len(tries)} tries end wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
