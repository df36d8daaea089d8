"""What the scripts under examples/paper and examples/validation share: a result, its numbers beside what they must be, its page.

Each folder there has a run.py that makes one Result. What it writes, out/dossier/<group>/<name>/results.json, is what
scripts/make_dossier gathers into docs/validation.md."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
import pages

matplotlib.use("Agg")  # pictures are files here

ROOT = Path(__file__).resolve().parents[1]
VALUES = ROOT / "examples" / "validation" / "reference_values.json"
MARKS = ("<!-- what we get -->", "<!-- end -->")


class Result:
    """What one script finds, beside what others say or what must hold. finish() writes out/dossier/<group>/<name>/,
    brings README.md up to date where --write is given, and ends the script with 1 where something does not hold."""

    def __init__(self, script: str, title: str, results: Path = ROOT / "out" / "dossier") -> None:
        self.folder = Path(script).resolve().parent
        self.out = results / self.folder.parent.name / self.folder.name
        self.out.mkdir(parents=True, exist_ok=True)
        (self.out / "results.json").unlink(missing_ok=True)  # a script that breaks off leaves no older result behind
        self.title = title
        self.parts: list[str] = []
        self.checks: list[dict[str, Any]] = []
        self.began = time.perf_counter()

    def scene(self, name: str = "scene.yaml") -> Path:
        """A file beside the script."""
        return self.folder / name

    def reference(self, entry: str) -> dict[str, Any]:
        """An entry of reference_values.json, whose `case` must be this folder: so none is left without a script."""
        own: dict[str, Any] = json.loads(VALUES.read_text())[entry]
        case = f"{self.folder.parent.name}/{self.folder.name}"
        if own.get("case") != case:
            raise ValueError(f"{VALUES.name}: {entry} must name its case {case}, not {own.get('case')}")
        return own

    def say(self, text: str) -> None:
        """A paragraph of the page."""
        self.parts.append(text)

    def table(self, columns: Sequence[str], rows: Sequence[Sequence[object]]) -> None:
        """A table of the page."""
        self.parts.append(pages.table(columns, rows))

    def picture(self, figure: Any, name: str, what: str) -> None:
        """A Matplotlib figure, kept as a file and shown in the page. `what` is told to who cannot see it."""
        for axes in figure.axes:
            if hasattr(axes, "zaxis"):
                axes.locator_params(nbins=4)  # labels have room
            elif axes.get_xscale() == "log" and axes.xaxis.get_transform().base == 2:
                axes.xaxis.set_major_formatter("{x:g}")  # 8, not 2 to the power of 3
        deep = any(hasattr(axes, "zaxis") for axes in figure.axes)
        figure.savefig(self.out / name, dpi=110, bbox_inches="tight" if deep else None, pad_inches=0.3)  # labels of z are cut otherwise
        self.parts.append(f"![{what}]({name})")

    def check(self, what: str, value: float, least: float = float("-inf"), most: float = float("inf"), unit: str = "") -> None:
        """Asserts least <= value <= most."""
        low, high = least > float("-inf"), most < float("inf")
        if low and high:
            must = f"{least:.4g} to {most:.4g}"
        else:
            must = f"at least {least:.4g}" if low else f"at most {most:.4g}"
        self._add(what, value, unit, must=must, holds=bool(least <= value <= most))

    def compare(
        self, what: str, ours: float, reference: float, tolerance: float, unit: str = "", source: str = "", of: float | None = None
    ) -> None:
        """Asserts that ours is within tolerance of what `source` says, relative to the reference, or to `of` where the reference may vanish."""
        deviation = abs(ours - reference) / abs(reference if of is None else of)
        self._add(
            what, ours, unit, must=f"{reference:.6g} within {100 * tolerance:.3g} %", holds=bool(deviation <= tolerance),
            reference=reference, source=source, deviation=deviation, tolerance=tolerance,
        )

    def compare_all(
        self, what: str, ours: Any, reference: Any, tolerance: float, unit: str = "", source: str = "", of: float | None = None
    ) -> None:
        """Asserts the same of every number of two arrays; the one that is furthest off is told."""
        own, right = np.ravel(np.asarray(ours, dtype=float)), np.ravel(np.asarray(reference, dtype=float))
        if own.shape != right.shape or own.size == 0:
            raise ValueError(f"{what}: {own.size} numbers beside {right.size} of the reference")
        off = np.abs(own - right) / np.abs(right if of is None else of)
        worst = int(np.argmax(np.where(np.isnan(off), np.inf, off)))
        self.compare(f"{what} (worst of {own.size})", own[worst], right[worst], tolerance, unit, source, of)

    def tell(self, what: str, ours: float, reference: float, unit: str = "", source: str = "") -> None:
        """A number beside that of others which is shown and not asserted, as a time is."""
        self._add(what, ours, unit, must=f"{reference:.6g}, not asserted", holds=True, reference=reference, source=source, told=True)

    def finish(self) -> None:
        """Writes what was found; ends the script with 1 where something does not hold."""
        rows = [
            [own["what"], f"{own['value']:.6g} {own['unit']}", f"{own['must']} {own['unit']}",
             f"{100 * own['deviation']:.2g} %" if "deviation" in own else "", "told" if "told" in own else "yes" if own["holds"] else "**no**"]
            for own in self.checks
        ]
        compared = any(row[3] for row in rows)
        if not compared:
            rows = [[*row[:3], row[4]] for row in rows]
        self.table(["asserted", "value", "must be", *(["deviation"] if compared else []), "holds"], rows)
        text = "\n\n".join(self.parts)
        seconds = time.perf_counter() - self.began
        (self.out / "results.md").write_text(f"# {self.title}\n\n{text}\n")
        (self.out / "results.json").write_text(
            json.dumps(
                {"title": self.title, "seconds": round(seconds, 1), "commit": _commit(), "date": time.strftime("%F"), "checks": self.checks},
                indent=1,
            )
            + "\n"
        )
        if "--write" in sys.argv[1:]:
            self._write(text)
        print(f"{self.title}: {seconds:.0f} s")
        for row in rows:
            print("  " + {"yes": "holds     ", "told": "is told   "}.get(row[-1], "DOES NOT  ") + f"{row[0]}: {row[1]} ({row[2]})")
        if not all(own["holds"] for own in self.checks):
            raise SystemExit(1)

    def _add(self, what: str, value: float, unit: str, **more: Any) -> None:
        self.checks.append({"what": what, "value": float(value), "unit": unit, **more})

    def _write(self, text: str) -> None:
        page = self.folder / "README.md"
        before, rest = page.read_text().split(MARKS[0])
        after = rest.split(MARKS[1])[1]
        page.write_text(f"{before}{MARKS[0]}\n\n{text}\n\n{MARKS[1]}{after}")
        for picture in self.out.glob("*.png"):
            shutil.copyfile(picture, self.folder / picture.name)


def run_all(group: Path, usage: str | None) -> None:
    """Runs every run.py of a group of folders, one after the other; ends with 1 if one of them fails. `usage` is what --help tells."""
    if any(option in sys.argv[1:] for option in ("-h", "--help")):
        print(usage)
        return
    begin = time.perf_counter()
    failed = []
    for script in sorted(group.glob("*/run.py")):
        (ROOT / "out" / "dossier" / group.name / script.parent.name / "results.json").unlink(missing_ok=True)
        if subprocess.run([sys.executable, str(script), *sys.argv[1:]], check=False).returncode:
            failed.append(script.parent.name)
    print(f"{time.perf_counter() - begin:.0f} s; " + ("not as told: " + ", ".join(failed) if failed else "all as told"))
    raise SystemExit(1 if failed else 0)


def _commit() -> str:
    told = subprocess.run(["git", "-C", str(ROOT), "rev-parse", "--short", "HEAD"], capture_output=True, text=True, check=False)
    return told.stdout.strip() or "unknown"
