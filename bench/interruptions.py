"""How soon runs end that are asked to, and what becomes of those that are killed.

    python3 bench/interruptions.py end  --program build/release/sinew SCENE ...   SIGTERM at random moments
    python3 bench/interruptions.py kill --program build/release/sinew SCENE ...   SIGKILL, then --resume

`end` prints the time from the signal to the exit; every recording must be readable. `kill` compares a resumed folder,
file by file, with that of a run that nothing disturbed (of report.json all but the times); half of the moments lie
between the last step and the exit.
"""

from __future__ import annotations

import argparse
import json
import random
import shutil
import signal
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

# Exit codes of a run that was asked to end: it was done already, it was interrupted, or it had not begun, when the
# signal ends the program as usual.
ENDED = (0, 130, -signal.SIGTERM)


def start(program: str, *arguments: str) -> subprocess.Popen[bytes]:
    return subprocess.Popen(
        [program, *arguments], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, stdin=subprocess.DEVNULL
    )


def run_whole(program: str, scene: Path, folder: Path) -> tuple[float, float]:
    """Seconds until the last step was recorded, and until the exit."""
    begin = time.monotonic()
    process = start(program, "run", str(scene), "-o", str(folder), "-q")
    stepped, size = 0.0, -1
    while process.poll() is None:
        recording = folder / "run.sinew"
        now = recording.stat().st_size if recording.exists() else -1
        if now != size:
            stepped, size = time.monotonic() - begin, now
        time.sleep(0.002)
    return stepped, time.monotonic() - begin


def readable(program: str, folder: Path) -> bool:
    """An export reads every step; a run that was stopped before it began has nothing to read."""
    recording = folder / "run.sinew"
    if not recording.exists() or recording.stat().st_size == 0:
        return True
    return start(program, "export", str(folder)).wait() == 0


def end_at(program: str, scene: Path, folder: Path, moment: float) -> tuple[float, bool]:
    """Seconds from SIGTERM to the exit, and whether all is well with what is left."""
    process = start(program, "run", str(scene), "-o", str(folder), "-q")
    time.sleep(moment)
    if process.poll() is not None:
        return 0.0, True
    asked = time.monotonic()
    process.send_signal(signal.SIGTERM)
    code = process.wait()
    took = time.monotonic() - asked
    return took, code in ENDED and readable(program, folder)


def content(folder: Path) -> dict[str, object]:
    files: dict[str, object] = {}
    for path in sorted(folder.rglob("*")):
        if not path.is_file():
            continue
        name = str(path.relative_to(folder))
        files[name] = path.read_bytes()
        if name == "report.json":
            report = json.loads(path.read_text())
            report.pop("time_per_step", None)
            files[name] = report
    return files


def resumed(program: str, scene: Path, folder: Path, moment: float) -> str:
    """Kills a run and resumes it: "" if that went well, or what did not."""
    process = start(program, "run", str(scene), "-o", str(folder), "-q")
    try:
        process.wait(moment)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()
    recording = folder / "run.sinew"
    if not recording.exists() or recording.stat().st_size == 0:  # nothing to go on from
        shutil.rmtree(folder, ignore_errors=True)
        return ""
    return "" if start(program, "run", "--resume", str(folder), "-q").wait() == 0 else "resume fails"


def differing(one: dict[str, object], other: dict[str, object]) -> list[str]:
    return sorted(name for name in {*one, *other} if one.get(name) != other.get(name))


def test_end(program: str, scenes: list[Path], moments: int, seed: int) -> int:
    generator = random.Random(seed)
    took: list[tuple[float, str, float]] = []
    bad = 0
    with tempfile.TemporaryDirectory() as temporary:
        for scene in scenes:
            for _ in range(moments):
                folder = Path(temporary) / "out"
                shutil.rmtree(folder, ignore_errors=True)
                moment = generator.uniform(0.05, 3.0)
                seconds, well = end_at(program, scene, folder, moment)
                took.append((seconds, scene.name, moment))
                bad += 0 if well else 1
                if not well:
                    print(f"{scene.name}: interrupted at {moment:.3f} s, not readable", flush=True)
    seconds = [own[0] for own in took]
    print(f"{len(took)} runs, median {statistics.median(seconds):.3f} s, longest {max(seconds):.3f} s")
    for own in sorted(took, reverse=True)[:5]:
        print(f"  {own[0]:.3f} s  {own[1]}, asked at {own[2]:.3f} s")
    return 1 if bad else 0


def test_kill(program: str, scenes: list[Path], moments: int, seed: int) -> int:
    generator = random.Random(seed)
    runs = bad = 0
    with tempfile.TemporaryDirectory() as temporary:
        for scene in scenes:
            # Recordings name no folder of results, so all runs of a scene have equal bytes.
            whole = Path(temporary) / "whole"
            shutil.rmtree(whole, ignore_errors=True)
            stepped, ended = run_whole(program, scene, whole)
            expected = content(whole)
            for number in range(moments):
                folder = Path(temporary) / "killed"
                shutil.rmtree(folder, ignore_errors=True)
                moment = generator.uniform(stepped, ended) if number % 2 else generator.uniform(0.02, stepped)
                problem = resumed(program, scene, folder, moment)
                if not problem and folder.exists():
                    names = differing(expected, content(folder))
                    problem = ", ".join(names) + " differ" if names else ""
                runs += 1
                if problem:
                    bad += 1
                    print(f"{scene.name}: killed at {moment:.3f} of {ended:.3f} s: {problem}", flush=True)
            print(f"{scene.name}: {moments} kills, last step at {stepped:.2f} s, exit at {ended:.2f} s", flush=True)
    print(f"{runs} kills, {bad} not as the unbroken run")
    return 1 if bad else 0


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=["end", "kill"])
    parser.add_argument("scenes", nargs="+", type=Path)
    parser.add_argument("--program", default="build/release/sinew")
    parser.add_argument("--moments", type=int, default=20, help="of each scene")
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    test = test_end if given.what == "end" else test_kill
    return test(given.program, given.scenes, given.moments, given.seed)


if __name__ == "__main__":
    sys.exit(main())
