"""What the tests share."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
EXAMPLES = ROOT / "examples"

SMALL = """
time: {step: 10 ms, duration: 0.1 s}
gravity: [0, 0, -9.81]
rods:
  arm: {path: [[0, 0, 0], [0.2, 0, 0]], sections: 4, section: {circle: {radius: 5 mm}}, material: {young: 1 MPa, poisson: 0.4, density: 1100}}
actuators: {draw: {rod: arm, tendon: {distance: 4 mm}, tension: external}}
loads: {weight: {rod: arm, force: [0, 0, -0.01], factor: external}}
outputs: {tip: {rod: arm, at: 0.2}}
"""


@pytest.fixture(scope="session")
def program() -> str:
    """The program that came with the package, or was built beside it."""
    found = shutil.which("sinew") or shutil.which("sinew", path=ROOT / "build" / "release")
    if found is None:
        pytest.skip("the program sinew is not installed")
    return found


@pytest.fixture(scope="session")
def finger() -> Path:
    return EXAMPLES / "finger.yaml"


@pytest.fixture
def small(tmp_path: Path) -> Path:
    """A rod with a tendon: steps in a tenth of a millisecond."""
    path = tmp_path / "small.yaml"
    path.write_text(SMALL)
    return path
