"""The scenes of tests/validation/faults, and what their judges share."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import yaml

from ..scene import ROOT, Case, Row, Scene, judge_program, run

FOLDER = ROOT / "tests/validation/faults"
FULL = ["torsion", "bending_y", "bending_z", "elongation", "shear_y", "shear_z"]


@lru_cache(maxsize=None)
def text_of(name: str) -> str:
    return (FOLDER / f"{name}.yaml").read_text()


def fault(name: str) -> Scene:
    scene: Scene = yaml.safe_load(text_of(name))
    for solid in scene.get("solids", {}).values():
        solid["mesh"] = str((FOLDER / solid["mesh"]).resolve())
    scene["view"] = {"interval": 1000}
    return scene


def codes(report: Any) -> set[str]:
    return {own["code"] for own in report["warnings"]}


def end_of(report: Any) -> str:
    """ "done", or the status with which a run stopped, and why."""
    end = report["end"]
    return "done" if end["how"] == "done" else f"{end.get('status', end['how'])} {end.get('where', '')}"


def second(scene: Scene) -> tuple[list[Row], Any]:
    """Rows and report of another scene."""
    verdict = run(Case("second", 0, scene), judge_program())
    return verdict.rows, verdict.report
