"""Variations of scenes that once ended `converged` and wrong, or not at all (tests/validation/faults), each beside what is
right."""

from __future__ import annotations

from ..scene import Maker
from .constraints import endwise, tendons, welds
from .missed import beside_post, folds, hook, loop, pushed, sleeve, tunnel, two_pins
from .stopped import free_turn, pressed, thin_struck
from .told import channel, curled, one_linearisation, pulled_far, ripple, tubes
from .unreal import lifted, overlap, pass_by, spinning, struck

FAULTS: dict[str, Maker] = {
    "tendons": tendons, "welds": welds, "endwise": endwise, "hook": hook, "pushed": pushed, "loop": loop, "tunnel": tunnel,
    "two_pins": two_pins, "sleeve": sleeve, "beside_post": beside_post, "pass_by": pass_by, "overlap": overlap,
    "spinning": spinning, "struck": struck, "tubes": tubes, "curled": curled, "one_linearisation": one_linearisation,
    "ripple": ripple, "channel": channel, "pulled_far": pulled_far, "lifted": lifted, "pressed": pressed,
    "thin_struck": thin_struck, "free_turn": free_turn, "folds": folds,
}
