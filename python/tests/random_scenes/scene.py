"""What all kinds of random scenes share: vectors, shapes, cases, and a run of the program."""

from __future__ import annotations

import csv
import json
import math
import random
import subprocess
import tempfile
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Callable

Scene = dict[str, Any]
Row = dict[str, float]
Vec = tuple[float, float, float]
Judge = Callable[[list[Row], Any], list[str]]
Maker = Callable[[random.Random], tuple[Scene, Judge]]

ROOT = Path(__file__).resolve().parents[3]


def sub(a: Vec, b: Vec) -> Vec:
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def dot(a: Vec, b: Vec) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vec, b: Vec) -> Vec:
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def mix(a: Vec, b: Vec, t: float) -> Vec:
    return (a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2]))


def norm(a: Vec) -> float:
    return math.sqrt(dot(a, a))


def crosses(p: Vec, q: Vec, a: Vec, b: Vec, c: Vec) -> bool:
    """Whether the segment pq passes through the triangle abc."""
    n = cross(sub(b, a), sub(c, a))
    d, e = dot(sub(p, a), n), dot(sub(q, a), n)
    if d * e >= 0.0:
        return False
    x = mix(p, q, d / (d - e))
    sides = [dot(cross(sub(v, u), sub(x, u)), n) for u, v in ((a, b), (b, c), (c, a))]
    return min(sides) >= 0.0 or max(sides) <= 0.0


def segment_distance(p: Vec, q: Vec, a: Vec, b: Vec) -> float:
    """Of two segments."""
    u, v, w = sub(q, p), sub(b, a), sub(p, a)
    uu, uv, vv, uw, vw = dot(u, u), dot(u, v), dot(v, v), dot(u, w), dot(v, w)
    best = math.inf
    den = uu * vv - uv * uv
    places = [(0.0, None), (1.0, None), (None, 0.0), (None, 1.0)]
    if den > 1e-14 * max(uu * vv, 1e-300):
        places.append(((uv * vw - vv * uw) / den, (uu * vw - uv * uw) / den))
    for s, t in places:
        if s is None and t is not None:
            s = (t * uv - uw) / uu if uu > 0 else 0.0
        if t is None and s is not None:
            t = (s * uv + vw) / vv if vv > 0 else 0.0
        assert s is not None and t is not None
        s, t = min(max(s, 0.0), 1.0), min(max(t, 0.0), 1.0)
        best = min(best, norm(sub(mix(p, q, s), mix(a, b, t))))
    return best


def at(row: Row, name: str) -> Vec:
    return (row[name + ".x"], row[name + ".y"], row[name + ".z"])


def table(h: float, steps: int, u: Vec) -> dict[str, Any]:
    """A frame that moves evenly along u in all."""
    return {"times": [0, h * steps], "translate": [[0, 0, 0], list(u)]}


def from_nowhere(rows: list[Row]) -> list[str]:
    """Energy that was neither there nor put in, beyond a few thousandths of the most there was, by the run's columns."""
    if not rows or "energy.work_bound" not in rows[0]:
        return []
    most, least = 0.0, math.inf
    for row in rows:
        stored = row["energy.kinetic"] + row["energy.elastic"]
        own = stored + row["energy.weight"] - row["energy.work_bound"]
        most, least = max(most, stored), min(least, own)
        gain = own - least
        if gain > 3e-3 * most and most > 1e-12:
            return [f"{gain:.3g} J from nowhere of {most:.3g} J at t = {row['time']:.4g} s, without a word"]
    return []


def circle(radius: float) -> float:
    """Second moment of area."""
    return 0.25 * math.pi * radius**4


def shape_of(random_: random.Random, size: float) -> tuple[dict[str, Any], float, float]:
    """A body's shape, its least extent, and the radius of the ball about it."""
    kind = random_.choice(["sphere", "capsule", "box", "cylinder"])
    if kind == "sphere":
        return {"sphere": {"radius": size}}, 2 * size, size
    if kind == "box":
        edges = [2 * size * random_.uniform(0.1, 1.0) for _ in range(3)]
        return {"box": {"size": edges}}, min(edges), 0.5 * math.hypot(*edges)
    radius, length = size * random_.uniform(0.1, 1.0), 2 * size * random_.uniform(0.1, 1.0)
    if kind == "capsule":
        return {"capsule": {"radius": radius, "length": length}}, 2 * radius, radius + 0.5 * length
    return {"cylinder": {"radius": radius, "length": length}}, min(2 * radius, length), math.hypot(radius, 0.5 * length)


@dataclass
class Case:
    kind: str
    number: int
    scene: Scene
    judge: Judge = lambda rows, report: []


def seconds(value: float | str) -> float:
    """A time of a scene: a number, or one with its unit."""
    if not isinstance(value, str):
        return value
    number, unit = value.split()
    return float(number) * {"s": 1.0, "ms": 1e-3, "us": 1e-6}[unit]


@dataclass
class Verdict:
    case: Case
    end: str
    complaints: list[str] = field(default_factory=list)
    rows: list[Row] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)
    report: Any = None

    @property
    def mean_step(self) -> float:
        """Of the steps that were accepted, in steps of the scene; 1 where time does not go on by steps."""
        if self.case.scene.get("analysis", "dynamic") not in ("dynamic", "quasi_static") or len(self.rows) < 2:
            return 1.0
        made = (self.rows[-1]["time"] - self.rows[0]["time"]) / (len(self.rows) - 1)
        return made / seconds(self.case.scene["time"]["step"])


_program = [str(ROOT / "build/release/sinew")]


def use_program(program: str) -> None:
    """That judges run, too."""
    _program[0] = program


def judge_program() -> str:
    return _program[0]


def read_rows(path: Path) -> list[Row]:
    rows = []
    with open(path, newline="") as stream:
        for row in csv.DictReader(stream):
            rows.append({key: float(value) for key, value in row.items() if value and key not in ("status", "targets")})
    return rows


def run(case: Case, program: str, limit: float = 120.0, keep: Path | None = None) -> Verdict:
    """Runs a scene and judges it."""
    with tempfile.TemporaryDirectory() as name:
        folder = keep or Path(name)
        folder.mkdir(parents=True, exist_ok=True)
        for solid in case.scene.get("solids", {}).values():
            if not Path(solid["mesh"]).is_absolute():
                (folder / solid["mesh"]).write_bytes((ROOT / "examples/meshes" / solid["mesh"]).read_bytes())
        (folder / "scene.yaml").write_text(json.dumps(case.scene, indent=1))
        try:
            done = subprocess.run([program, "run", folder / "scene.yaml", "-o", folder / "out", "--quiet", "--force"],
                                  capture_output=True, text=True, timeout=limit)
        except subprocess.TimeoutExpired:
            return Verdict(case, "hangs", [f"not through after {limit:g} s"])
        if done.returncode < 0 or done.returncode not in (0, 1, 2, 3):
            return Verdict(case, "crash", [f"exit code {done.returncode}: {done.stderr[-300:]}"])
        report_file = folder / "out" / "report.json"
        if not report_file.exists():
            return Verdict(case, "refused", [done.stderr[-300:]])
        report = json.loads(report_file.read_text())
        rows = read_rows(folder / "out" / "signals.csv")
        complaints = case.judge(rows, report)
        for row in rows:
            if not all(math.isfinite(value) for value in row.values()):
                complaints.append(f"not finite at t = {row['time']:.4g} s")
                break
        end = "done" if done.returncode == 0 else "stopped: " + " ".join(done.stderr.split())[-300:]
        return Verdict(case, end, complaints, rows, [own["code"] for own in report["warnings"]], report)
