"""Random legal scenes, run by the program and judged by what does not come from it.

Each scene follows from its kind and its number alone. A run may stop with a status; it may not be wrong.
"""

from __future__ import annotations

import random

from .faults import FAULTS
from .frames import moving_frame
from .legal import legal
from .scene import Case, Maker, Verdict, run, use_program
from .throws import THROWS, judge_rod_peg

__all__ = ["FAULTS", "KINDS", "Case", "Verdict", "judge_rod_peg", "make", "run", "use_program"]

KINDS: dict[str, dict[str, Maker]] = {
    "throws": THROWS,
    "scenes": {"legal": legal},
    "frames": {"moving_frame": moving_frame},
    "faults": FAULTS,
}


def make(group: str, number: int) -> Case:
    """The scene of a kind and a number."""
    kinds = KINDS[group]
    names = list(kinds)
    random_ = random.Random(f"{group} {number}")
    name = names[number % len(names)]
    if group == "throws":  # the last takes longest, and is every tenth
        name = names[-1] if number % 10 == 9 else names[number % (len(names) - 1)]
    scene, judge = kinds[name](random_)
    return Case(name, number, scene, judge)
