"""The examples run, and their assertions hold."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import ROOT


@pytest.mark.parametrize("file", sorted((ROOT / "python" / "examples").glob("*.py")), ids=lambda file: file.stem)
def test_example(file: Path, tmp_path: Path) -> None:
    told = subprocess.run(
        [sys.executable, file],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
        env={**os.environ, "MPLBACKEND": "Agg"},
    )
    assert told.returncode == 0, told.stderr
    for picture in tmp_path.glob("*.png"):
        assert picture.stat().st_size > 10_000
