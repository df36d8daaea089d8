"""The dossier: its cases hold, its types are right, and nothing that fails or is missing can be hidden in it."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import EXAMPLES, ROOT

CASES = sorted(file.parent for group in ("validation", "paper") for file in (EXAMPLES / group).glob("*/run.py"))
QUICK = {"circle", "slope", "tendon", "spring", "cook_membrane", "elastica", "prebent", "sections"}
"""Some seconds in all; one of each kind of thing."""
DOSSIER = ROOT / "scripts" / "make_dossier"


@pytest.mark.parametrize(
    "case", [pytest.param(own, marks=[] if own.name in QUICK else pytest.mark.slow) for own in CASES], ids=lambda own: own.name
)
def test_case(case: Path) -> None:
    pytest.importorskip("matplotlib")
    told = subprocess.run([sys.executable, case / "run.py"], capture_output=True, text=True, check=False)
    if told.returncode and "cannot be fetched from" in told.stderr:
        pytest.skip(f"the paper's meshes are not here: {told.stderr}")
    assert told.returncode == 0, told.stdout + told.stderr
    assert "holds" in told.stdout


def test_every_case_has_a_page_with_what_we_get() -> None:
    assert len(CASES) >= 30
    assert {own.name for own in CASES} >= QUICK
    for case in CASES:
        page = (case / "README.md").read_text()
        between = page.split("<!-- what we get -->")[1].split("<!-- end -->")[0]
        assert "| asserted |" in between, f"{case.name}: run it with --write"
        assert f"examples/{case.parent.name}/{case.name}/run.py" in page


SCRIPTS = [EXAMPLES / "validation" / "validation.py", EXAMPLES / "paper" / "paper.py", EXAMPLES / "paper" / "pictures.py", EXAMPLES / "dossier.py", DOSSIER]


@pytest.mark.parametrize("script", [*CASES, *SCRIPTS], ids=lambda own: own.name)
@pytest.mark.slow
def test_types(script: Path) -> None:
    pytest.importorskip("mypy")
    file = script / "run.py" if script.is_dir() else script
    group = EXAMPLES / ("paper" if EXAMPLES / "paper" in script.parents else "validation")
    told = subprocess.run(
        [sys.executable, "-m", "mypy", "--strict", "--config-file", ROOT / "pyproject.toml", file],
        capture_output=True,
        text=True,
        check=False,
        cwd=group,
        env={**os.environ, "MYPYPATH": f"{EXAMPLES}:{group}"},
    )
    assert told.returncode == 0, told.stdout + told.stderr


CHECK = """
import sys
from pathlib import Path
sys.path.insert(0, {examples!r})
from dossier import Result
result = Result(__file__, "A test", Path(__file__).parent)
result.{line}
result.finish()
"""


@pytest.mark.parametrize(
    ("line", "code"),
    [
        ("check('a', 1.0, most=2.0)", 0),
        ("check('a', 3.0, most=2.0)", 1),
        ("check('a', float('nan'), most=2.0)", 1),
        ("compare('a', 1.01, 1.0, 0.02)", 0),
        ("compare('a', 1.03, 1.0, 0.02)", 1),
        ("compare('a', float('nan'), 1.0, 0.02)", 1),
        ("compare_all('a', [1.0, 2.03], [1.0, 2.0], 0.02)", 0),
        ("compare_all('a', [1.0, 2.05], [1.0, 2.0], 0.02)", 1),
        ("compare_all('a', [1.0, float('nan')], [1.0, 2.0], 0.02)", 1),
        ("compare_all('a', [1.0], [1.0, 2.0], 0.02)", 1),
        ("tell('a', 3.0, 1.0)", 0),
    ],
)
def test_what_does_not_hold_ends_with_1(line: str, code: int, tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    (tmp_path / "run.py").write_text(CHECK.format(examples=str(EXAMPLES), line=line))
    told = subprocess.run([sys.executable, tmp_path / "run.py"], capture_output=True, text=True, check=False)
    assert told.returncode == code, told.stdout + told.stderr


def results(folder: Path, left_out: str = "", wrong: str = "") -> Path:
    """Results of all cases, as their scripts would leave them."""
    values = json.loads((EXAMPLES / "validation" / "reference_values.json").read_text())
    cases = {f"{file.parents[1].name}/{file.parent.name}" for file in EXAMPLES.glob("*/*/run.py")}
    for case in cases | {own["case"] for own in values.values() if isinstance(own, dict) and "case" in own}:
        if case == left_out:
            continue
        check = {"what": "number", "value": 1.0, "unit": "m", "must": "1", "holds": case != wrong, "reference": 1.0, "source": "it", "deviation": 0.0, "tolerance": 0.1}
        (folder / case).mkdir(parents=True)
        (folder / case / "results.json").write_text(
            json.dumps({"title": f"Case {case}", "seconds": 1.0, "commit": "abc", "date": "2026-01-01", "checks": [check]})
        )
    return folder


@pytest.mark.parametrize(
    ("faults", "code", "shown"),
    [
        ({}, 0, "all hold"),
        ({"left_out": "validation/elastica"}, 1, "* validation/elastica: no result"),
        ({"wrong": "validation/elastica"}, 1, "| **no** |"),
    ],
)
def test_nothing_is_hidden(faults: dict[str, str], code: int, shown: str, tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    told = subprocess.run(
        [sys.executable, DOSSIER, "--results", results(tmp_path / "out", **faults), "--page", page], capture_output=True, text=True, check=False
    )
    assert told.returncode == code, told.stdout + told.stderr
    text = page.read_text()
    assert shown in text
    assert "Waits for pneumatic chambers with fibres" in text
    for case in CASES:
        assert f"../examples/{case.parent.name}/{case.name}/README.md" in text or case.name in faults.get("left_out", "")
