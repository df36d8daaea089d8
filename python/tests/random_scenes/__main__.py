"""Runs many of one kind.

    python -m random_scenes --kind throws --count 3000 --program build/release/sinew    (in python/tests)
"""

from __future__ import annotations

import argparse
import concurrent.futures
import os
import sys
from collections import Counter
from pathlib import Path

from . import KINDS, make, run, use_program
from .scene import ROOT


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--kind", choices=sorted(KINDS), default="throws")
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--program", default=str(ROOT / "build/release/sinew"))
    parser.add_argument("--keep", type=Path, help="a folder for scenes that are complained of")
    parser.add_argument("--verbose", action="store_true")
    arguments = parser.parse_args()
    use_program(arguments.program)
    ends: Counter[tuple[str, str]] = Counter()
    wrong = 0
    mean_steps: list[float] = []
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        cases = [make(arguments.kind, number) for number in range(arguments.first, arguments.first + arguments.count)]
        for verdict in pool.map(lambda case: run(case, arguments.program), cases):
            case = verdict.case
            ends[case.kind, verdict.end.split(":")[0]] += 1
            mean_steps.append(verdict.mean_step)
            slow = f" (at {verdict.mean_step:.2g} of its step)" if verdict.mean_step < 0.1 else ""
            if verdict.complaints or (arguments.verbose and (slow or verdict.end != "done")):
                print(f"{case.kind} {case.number}{slow}: {verdict.end}; {'; '.join(verdict.complaints)}", flush=True)
            if verdict.complaints:
                wrong += 1
                if arguments.keep:
                    run(case, arguments.program, keep=arguments.keep / f"{case.kind}_{case.number}")
    for (kind, end), count in sorted(ends.items()):
        print(f"{kind:16} {end:10} {count}")
    for part in (0.1, 0.01):
        print(f"{sum(step < part for step in mean_steps)} of {arguments.count} run at less than {part:g} of their step,"
              " on average")
    print(f"{wrong} of {arguments.count} wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
