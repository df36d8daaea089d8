"""How long runs take that come to nothing, and what they say in the end.

    python3 bench/time_to_fail.py --program build/release/sinew [--before OTHER/sinew] [NAME ...]

Prints a row of Markdown for each scene: processor seconds of each program, how the run ended, and its `detail`.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import subprocess
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
LIMIT_S = 400

FAULTS, EXAMPLES = "tests/validation/faults/", "examples/"
FINGER = "solids.finger.material"
SCENES: dict[str, tuple[str, list[str]]] = {
    "chamber, static": (FAULTS + "too_much_pressure.yaml", []),
    "chamber, quasi-static": (FAULTS + "too_much_pressure.yaml", ["analysis=quasi_static", "time.step=0.1 s", "time.duration=1 s"]),
    "chamber, dynamic": (FAULTS + "too_much_pressure.yaml", ["analysis=dynamic", "time.step=10 ms", "time.duration=1 s"]),
    "three chambers at 400 kPa": (EXAMPLES + "chambers.yaml", ["loads.air.pressure=400 kPa"]),
    "three chambers, linear elements, 1 MPa": (EXAMPLES + "chambers.yaml", ["loads.air.pressure=1 MPa", "solids.bar.order=1"]),
    "three chambers, sucked at 300 kPa": (EXAMPLES + "chambers.yaml", ["loads.air.pressure=-300 kPa"]),
    "finger of neo-Hooke under 1000 g, static": (EXAMPLES + "finger.yaml", ["analysis=static", "gravity=[0, 0, -10000]", f"{FINGER}.law=neo_hookean"]),
    "finger of neo-Hooke, cable 80 mm in 1 s": (EXAMPLES + "finger.yaml", [f"{FINGER}.law=neo_hookean", "actuators.pull.displacement.values=[0, 80 mm]"]),
    "finger, cable 80 mm at rest": (EXAMPLES + "finger.yaml", ["analysis=quasi_static", "actuators.pull.displacement.values=[0, 80 mm]"]),
    "finger, cable 80 mm, static": (EXAMPLES + "finger.yaml", ["analysis=static", "time.duration=1 s", "actuators.pull.displacement.values=[0, 80 mm]"]),
    "finger, cable pulled with 1 kN": (EXAMPLES + "finger.yaml", ["actuators.pull={rod: cable, force: 1000 N}"]),
    "rod turned in a block of 100 Pa": (EXAMPLES + "prebent_rod.yaml", ["solids.block.material.young=100 Pa"]),
    "arm, tendon of 10 kN": (EXAMPLES + "tendon_arm.yaml", ["actuators.side.tension=10 kN"]),
    "arm, tendon of 10 kN, static": (EXAMPLES + "tendon_arm.yaml", ["analysis=static", "actuators.side.tension=10 kN"]),
    "two meshes within each other": (FAULTS + "two_meshes.yaml", []),
    "a capsule on a hull": (FAULTS + "slow_capsule_hull.yaml", []),
    "tendons that contradict, static": (FAULTS + "tendons_contradict.yaml", ["analysis=static"]),
    "a path with limit points": (FAULTS + "path_limit.yaml", []),
    "three chambers at 2 MPa, dynamic": (EXAMPLES + "chambers.yaml", ["analysis=dynamic", "time={step: 2 ms, duration: 0.1 s}", "loads.air.pressure=2 MPa"]),
    "cables that contradict": (FAULTS + "cables_contradict.yaml", []),
}


def attempt(program: str, name: str) -> tuple[float, str, str]:
    """Processor seconds, how it ended, and why."""
    scene, changes = SCENES[name]
    with tempfile.TemporaryDirectory() as folder:
        command = ["timeout", "-s", "KILL", str(LIMIT_S), program, "run", str(ROOT / scene), "-o", folder + "/out", "-q",
                   "--threads", "1", *(part for change in changes for part in ("--set", change))]
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        done = subprocess.run(command, check=False, capture_output=True, text=True)
        seconds = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
        report = Path(folder) / "out" / "report.json"
        if done.returncode < 0 or done.returncode == 137:
            return seconds, f"killed after {LIMIT_S} s", ""
        if not report.exists():
            return seconds, f"exit code {done.returncode}", " ".join(done.stderr.split())[:200]
        end = json.loads(report.read_text())["end"]
        return seconds, f"{end['how']} {end.get('status', '')} at {end['time_s']:.4g}".strip(), end.get("where", "")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", default=list(SCENES), help="of scenes; all if left out")
    parser.add_argument("--program", default=str(ROOT / "build/release/sinew"))
    parser.add_argument("--before", help="another build, to compare with")
    arguments = parser.parse_args()
    programs = [os.path.abspath(own) for own in (arguments.before, arguments.program) if own]
    print("| scene | " + " | ".join(["before [s]", "end before"] * bool(arguments.before) + ["now [s]", "end", "why"]) + " |")
    print("|---" * (6 if arguments.before else 4) + "|")
    for name in arguments.names:
        cells = [name]
        for program in programs:
            seconds, end, why = attempt(program, name)
            cells += [f"{seconds:.1f}", end]
        print("| " + " | ".join([*cells, why]) + " |", flush=True)


if __name__ == "__main__":
    main()
