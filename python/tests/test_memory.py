"""Nothing is kept of what is gone."""

from __future__ import annotations

import gc
import os
import time
from pathlib import Path

import pytest

import sinew


def resident() -> float:
    """[MiB] that the process holds."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 2**20


def cycle(tree: dict[str, object]) -> None:
    model = sinew.build(tree)
    state = model.initial_state()
    kept = state.rods["arm"].q
    sinew.step(model, [0.1], state)
    run = sinew.simulate(model, progress=False)
    assert kept.size and len(run) == 3


@pytest.mark.parametrize("count", [300, pytest.param(10_000, marks=pytest.mark.slow)])
def test_building_again_and_again_does_not_grow(small: Path, count: int) -> None:
    scene = sinew.Scene.from_file(small, {"time.duration": "20 ms"})
    tree = scene.tree()
    for _ in range(100):
        cycle(tree)
    gc.collect()
    before = resident()
    for _ in range(count):
        cycle(tree)
    gc.collect()
    assert resident() - before < 4.0


def test_importing_is_quick() -> None:
    import subprocess
    import sys

    times = []
    for _ in range(5):
        start = time.perf_counter()
        subprocess.run([sys.executable, "-c", "import sinew"], check=True)
        times.append(time.perf_counter() - start)
    bare = []
    for _ in range(5):
        start = time.perf_counter()
        subprocess.run([sys.executable, "-c", "import numpy"], check=True)
        bare.append(time.perf_counter() - start)
    assert min(times) < 0.3 + min(bare)
