"""Sinew simulates and controls soft robots that are moved by cables, rods and tubes.

>>> import sinew
>>> run = sinew.simulate("examples/finger.yaml")
>>> run.signals["tip.z"][-1]

A scene (a file, or made of `sinew.Scene`, `sinew.Solid`, `sinew.Rod`, ...) is built into a model; steps change its
states; a run keeps them all. Everything is in SI.
"""

from sinew._engine import (
    ActuatorJacobian,
    BodySnapshot,
    BodyState,
    Contact as ContactState,
    EnergyBalance,
    Manipulability,
    Model,
    Recorder,
    RodSnapshot,
    RodState,
    Run,
    Snapshot,
    SolidSnapshot,
    SolidState,
    State,
    RunWarning,
    StepReport,
    compliance,
    jacobian,
    manipulability,
    step,
    version as __version__,
)
from sinew.errors import InputError, Interrupted, StepFailed
from sinew.mesh import Mesh
from sinew.running import Workspace, build, map_workspace, read_run, simulate
from sinew.showing import Shown, show
from sinew.scene import *  # noqa: F403
from sinew.scene import __all__ as _scene_names

__all__ = [
    "ActuatorJacobian",
    "BodySnapshot",
    "BodyState",
    "ContactState",
    "EnergyBalance",
    "InputError",
    "Interrupted",
    "Manipulability",
    "Mesh",
    "Model",
    "Recorder",
    "RodSnapshot",
    "RodState",
    "Run",
    "Snapshot",
    "SolidSnapshot",
    "Shown",
    "SolidState",
    "State",
    "StepFailed",
    "RunWarning",
    "StepReport",
    "Workspace",
    "__version__",
    "build",
    "compliance",
    "jacobian",
    "manipulability",
    "map_workspace",
    "read_run",
    "show",
    "simulate",
    "step",
    *_scene_names,
]
