"""A short run of the random scenes; `python -m random_scenes` makes as many as one likes."""

from __future__ import annotations

import pytest
import random_scenes
from random_scenes import soundness

# Some that were wrong once, beside the first ones: throws 52 (a peg went through a rod that was bent round it).
NUMBERS = {
    "throws": [*range(30), 52],
    "frames": list(range(10)),
    "scenes": list(range(30)),
    "faults": list(range(len(random_scenes.FAULTS))),
}


# Variations of faults of which some numbers end with a status.
MAY_STOP = {"tendons", "endwise", "loop", "tunnel", "thin_struck", "folds"}


@pytest.mark.parametrize("kind", NUMBERS)
def test_random_scenes_end_right_or_say_why(kind: str, program: str) -> None:
    random_scenes.use_program(program)
    for number in NUMBERS[kind]:
        verdict = random_scenes.run(random_scenes.make(kind, number), program)
        assert verdict.end == "done" or verdict.end.startswith("stopped"), (number, verdict.end)
        assert not verdict.complaints, (number, verdict.complaints)
        assert kind != "faults" or verdict.case.kind in MAY_STOP or verdict.end == "done", (number, verdict.end)


def test_check_refuses_what_cannot_begin_and_only_that(program: str) -> None:
    for number in range(20):
        _, end, text = soundness.compare(number, program, None)
        assert "DISAGREE" not in end and "exit" not in end, (number, end, text)


def test_the_judge_sees_a_rod_that_passes_a_peg() -> None:
    names = ["p0", "p1"]
    judge = random_scenes.judge_rod_peg(names, ((0.4, 0.0, -1.0), (0.4, 0.0, 1.0)), lambda t: (0.0, 0.0, 0.0), 0.1, 0.0)

    def row(time: float, y: float) -> dict[str, float]:
        return {"time": time, "p0.x": 0.0, "p0.y": y, "p0.z": 0.0, "p1.x": 1.0, "p1.y": y, "p1.z": 0.0}

    assert judge([row(0.0, -1.0), row(1.0, -0.2)], None) == []
    assert "in the peg" in judge([row(0.0, -1.0), row(1.0, -0.05)], None)[0]
    assert "passes" in judge([row(0.0, -1.0), row(1.0, 1.0)], None)[0]
