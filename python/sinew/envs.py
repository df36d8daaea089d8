"""Soft robots as Gymnasium environments.

`SinewEnv` makes one of any scene; `ReachEnv` (a trunk brings its tip to a point) and `GraspEnv` (three fingers pick up a
cube) are ready to use, also as `gymnasium.make("sinew/Reach-v0")` once `sinew.envs` is imported. Many at once: over
processes by `gymnasium.vector.AsyncVectorEnv`, over threads by `ThreadVectorEnv`, as steps leave Python free.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import gymnasium
import numpy as np
import numpy.typing as npt

import sinew
from sinew import Mesh, Model, State
from sinew.running import SceneLike

Array = npt.NDArray[np.float64]


class SinewEnv(gymnasium.Env[Array, npt.NDArray[np.float32]]):
    """An environment of any scene.

    scene: its motors that are to be acted on are `external`.
    actions: least and most of what each of these motors is told, by their names, in SI. An action is a number between
    -1 (least) and 1 (most) for each.
    observed: outputs whose numbers are observed, in SI, followed by what the last action changed of them, and by the
    displacements and forces of the motors.
    rate: how far commands may go in one action, as a part of their range; 1 does not limit them.
    steps: of the scene that an action lasts; commands go there in as many parts.
    horizon: actions until an episode is truncated.

    A task overrides `begin`, `extra` and `reward`. Where a step cannot be made the episode is terminated, and
    `info["status"]` says why; its reward is then `worst` for every action that was left, so that nothing is gained by
    breaking the robot.
    """

    metadata = {"render_modes": ["rgb_array"], "render_fps": 50}
    worst = -10.0
    """What an action is worth at the least."""

    def __init__(
        self,
        scene: SceneLike,
        *,
        actions: Mapping[str, tuple[float, float]],
        observed: Sequence[str],
        rate: float = 0.2,
        steps: int = 1,
        horizon: int = 50,
        render_mode: str | None = None,
    ) -> None:
        self.model: Model = sinew.build(scene)
        self.names = list(actions)
        unknown = [name for name in self.names if name not in self.model.actuators]
        if unknown or not self.names:
            raise ValueError(f"actions: no motor {', '.join(unknown)}; known: {', '.join(self.model.actuators)}")
        if render_mode is not None and render_mode not in self.metadata["render_modes"]:
            raise ValueError(f"render_mode: must be 'rgb_array' or None, not {render_mode!r}")
        if isinstance(observed, str):
            raise ValueError("observed: must be a list of outputs")
        for name, own in actions.items():
            if not (np.isfinite(own).all() and own[0] < own[1]):
                raise ValueError(f"actions: {name} = {own}: must be the least and the most that it is told, in SI")
        if not (0.0 < rate <= 1.0) or steps < 1 or horizon < 1:
            raise ValueError("rate must be above 0 and at most 1; steps and horizon at least 1")
        self.motors = [self.model.actuators.index(name) for name in self.names]
        self.least = np.array([own[0] for own in actions.values()], dtype=np.float64)
        self.most = np.array([own[1] for own in actions.values()], dtype=np.float64)
        self.observed = list(observed)
        self.rate, self.steps, self.horizon = rate, steps, horizon
        self.render_mode = render_mode
        self.action_space = gymnasium.spaces.Box(-1.0, 1.0, (len(self.names),), np.float32)
        self.state: State = self.model.initial_state()
        self._start = self.state.copy()
        self._command = np.zeros(len(self.names))
        self._taken = 0
        self._options: dict[str, Any] = {}
        self._before = self._outputs()
        self.begin(np.random.default_rng(0))
        size = len(self.observe())
        self.observation_space = gymnasium.spaces.Box(-np.inf, np.inf, (size,), np.float64)

    # What a task is made of.

    def begin(self, random: np.random.Generator) -> None:
        """Makes up an episode: the goal, say. `options` of `reset` are in `self._options`."""

    def extra(self) -> Array:
        """What is observed besides outputs and motors."""
        return np.empty(0)

    def reward(self) -> tuple[float, bool]:
        """What the state is worth, and whether the task is done."""
        return 0.0, False

    # Gymnasium's interface.

    def _outputs(self) -> Array:
        return np.concatenate([np.empty(0), *(self.state.output(name) for name in self.observed)])

    def observe(self) -> Array:
        """All that is observed, in SI."""
        outputs = self._outputs()
        motors = [self.state.displacements[self.motors], self.state.forces[self.motors]]
        return np.concatenate([outputs, outputs - self._before, *motors, self.extra()])

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Array, dict[str, Any]]:
        super().reset(seed=seed)
        self.state = self._start.copy()
        self._command = np.clip(np.zeros(len(self.names)), self.least, self.most)
        self._taken = 0
        self._before = self._outputs()
        self._options = dict(options or {})
        self.begin(self.np_random)
        return self.observe(), {"status": "rest"}

    def step(
        self, action: npt.NDArray[np.float32]
    ) -> tuple[Array, float, bool, bool, dict[str, Any]]:
        wanted = np.asarray(action, dtype=np.float64)
        if wanted.shape != self.action_space.shape or not np.isfinite(wanted).all():
            raise ValueError(f"action: must be {len(self.names)} finite numbers between -1 and 1, not {action}")
        goal = self.least + (np.clip(wanted, -1.0, 1.0) + 1.0) / 2.0 * (self.most - self.least)
        reach = self.rate * (self.most - self.least)
        before, self._command = self._command, np.clip(goal, self._command - reach, self._command + reach)
        self._before = self._outputs()
        status = "rest"
        failed = False
        for part in range(1, self.steps + 1):
            told = before + part / self.steps * (self._command - before)
            report = sinew.step(self.model, dict(zip(self.names, told.tolist(), strict=True)), self.state)
            status, failed = report.status, not report.accepted
            if failed:
                break
        self._taken += 1
        value, done = self.reward()
        if failed:
            return self.observe(), self.worst * (self.horizon - self._taken + 1), True, False, {"status": status, "success": False}
        return self.observe(), value, done, self._taken >= self.horizon, {"status": status, "success": done}

    def render(self) -> npt.NDArray[np.uint8] | None:
        """A picture of the state."""
        if self.render_mode is None:
            return None
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure

        from sinew import plot

        figure = Figure(figsize=(5, 5), layout="constrained")
        canvas = FigureCanvasAgg(figure)
        plot.shape(self.state, figure.add_subplot(projection="3d"))
        canvas.draw()  # type: ignore[no-untyped-call]
        seen = np.asarray(canvas.buffer_rgba())  # type: ignore[no-untyped-call]
        return np.array(seen[:, :, :3], dtype=np.uint8)


def _spread(first: float, last: float, count: int) -> list[float]:
    """Abscissae of sliding points, one in the middle of each cell along and one at the tip."""
    return [*(first + (last - first) * (np.arange(count) + 0.5) / count).tolist(), last]


def trunk_scene(cells: tuple[int, int, int] = (8, 2, 2), sections: int = 10) -> sinew.Scene:
    """A tapered trunk of 195 mm with four cables, as the paper has it, of a mesh as coarse as wanted."""
    material = sinew.RodMaterial(young="5 GPa", poisson=0.4, density="1100 kg/m^3")
    ends = {"right": (1, 0), "back": (0, 1), "left": (-1, 0), "front": (0, -1)}
    return sinew.Scene(
        title="A trunk of four cables",
        time=sinew.Time(step="5 ms", duration="1 s"),
        newton=1,
        solids={
            "trunk": sinew.Solid(
                mesh=Mesh.bar((0.195, 0.03, 0.03), cells, taper=0.5),
                material=sinew.SolidMaterial(law="corotational", young="450 kPa", poisson=0.45),
                density="530 kg/m^3",
                rayleigh=sinew.Rayleigh(mass=0.1, stiffness=0.02),
                fixed=sinew.Held(group="start"),
            )
        },
        rods={
            name: sinew.Rod(
                path=[[-0.045, 0.0124 * y, 0.0124 * z], [0.195, 0.005 * y, 0.005 * z]],
                sections=sections,
                section=sinew.Circle(radius="0.5 mm"),
                material=material,
            )
            for name, (y, z) in ends.items()
        },
        couplings=[sinew.Slide(rod=name, solid="trunk", points=_spread(0.045, float(np.hypot(0.24, 0.0074)), cells[0])) for name in ends],
        actuators={f"pull_{name}": sinew.Actuator(rod=name, force="external") for name in ends},
        outputs={"tip": sinew.Output(solid="trunk", point=[0.195, 0, 0])},
    )


class ReachEnv(SinewEnv):
    """A trunk of four cables, each pulling with up to 5 N, brings its tip to a point on what it can reach.

    Observed: the tip [m] and its change, the motors, then the point [m], which `reset(options={"goal": [x, y, z]})` sets.
    The reward of an action is minus the distance in units of
    20 mm, and 1 more within 2 mm. `info["distance"]` [m] tells it."""

    def __init__(self, *, most: float = 5.0, render_mode: str | None = None, scene: SceneLike | None = None) -> None:
        self.goal = np.zeros(3)
        pulls = [f"pull_{name}" for name in ("right", "back", "left", "front")]
        super().__init__(
            scene if scene is not None else trunk_scene(),
            actions=dict.fromkeys(pulls, (0.0, most)),
            observed=["tip"],
            steps=4,
            render_mode=render_mode,
        )

    def begin(self, random: np.random.Generator) -> None:
        if "goal" in self._options:
            self.goal = np.array(self._options["goal"], dtype=np.float64).reshape(3)
            return
        angle, aside = random.uniform(0.0, 2.0 * np.pi), 0.05 * np.sqrt(random.uniform())
        self.goal = np.array(
            [0.195 - 0.6 * aside**2 / 0.195, aside * np.cos(angle), aside * np.sin(angle)]  # about the arc of a bar
        )

    def extra(self) -> Array:
        return self.goal

    def distance(self) -> float:
        """[m] from the tip to where it is to be."""
        return float(np.linalg.norm(self.state.output("tip") - self.goal))

    def reward(self) -> tuple[float, bool]:
        distance = self.distance()
        return -distance / 0.02 + (1.0 if distance < 0.002 else 0.0), False

    def step(self, action: npt.NDArray[np.float32]) -> tuple[Array, float, bool, bool, dict[str, Any]]:
        seen, value, done, truncated, info = super().step(action)
        info["distance"] = self.distance()
        info["success"] = info["distance"] < 0.002
        return seen, value, done, truncated, info


def gripper_scene(cells: tuple[int, int, int] = (6, 1, 1), sections: int = 10) -> sinew.Scene:
    """Three fingers on a hand that comes down over a cube, waits while they close, and goes up."""
    places = {
        "left": (0.0, [-0.025, 0.0, 0.137]),
        "right_front": (180.0, [0.025, -0.008, 0.137]),
        "right_back": (180.0, [0.025, 0.008, 0.137]),
    }
    poses = {
        name: sinew.Pose(rotate=[0, "90 deg", f"{turn} deg"], translate=where) for name, (turn, where) in places.items()
    }
    return sinew.Scene(
        title="Three fingers and a cube",
        time=sinew.Time(step="5 ms", duration="2 s"),
        newton=1,
        gravity=[0, 0, -9.81],
        frames={
            "hand": sinew.Frame(
                motion=sinew.FrameMotion(
                    times=[0, 0.2, 0.6, 1.0], translate=[[0, 0, 0], [0, 0, -0.04], [0, 0, -0.04], [0, 0, 0.01]]
                )
            )
        },
        solids={
            name: sinew.Solid(
                mesh=Mesh.bar((0.095, 0.014, 0.014), cells, taper=0.7),
                frame="hand",
                pose=pose,
                material=sinew.SolidMaterial(law="corotational", young="2 MPa", poisson=0.45),
                density="1070 kg/m^3",
                rayleigh=sinew.Rayleigh(mass=0.1, stiffness=0.02),
                fixed=sinew.Held(group="start"),
            )
            for name, pose in poses.items()
        },
        rods={
            f"{name}_cable": sinew.Rod(
                path=[[-0.04, 0, 0.002], [0.09, 0, 0.002]],
                frame="hand",
                pose=pose,
                sections=sections,
                section=sinew.Circle(radius="0.5 mm"),
                material=sinew.RodMaterial(young="5 GPa", poisson=0.4, density="1100 kg/m^3"),
            )
            for name, pose in poses.items()
        },
        couplings=[sinew.Slide(rod=f"{name}_cable", solid=name, points=_spread(0.04, 0.13, cells[0])) for name in places],
        actuators={
            f"{name}_pull": sinew.Actuator(rod=f"{name}_cable", force="external") for name in places
        },
        bodies={
            "cube": sinew.RigidBody(
                box=sinew.BoxShape(size=[0.02, 0.02, 0.02]), pose=sinew.Pose(translate=[0, 0, 0.01]), mass="30 g"
            )
        },
        obstacles={"floor": sinew.Obstacle(plane=sinew.PlaneShape(normal=[0, 0, 1]))},
        contact=sinew.Contact(friction=0.5),
        outputs={
            "cube": sinew.Output(body="cube"),
            **{name: sinew.Output(between=["cube", name]) for name in places},
        },
    )


class GraspEnv(SinewEnv):
    """Three fingers pick up a cube: the hand comes down, waits and goes up by itself; actions draw the fingers' cables, with
    up to 20 N each.

    Observed: the cube [m], what is between it and each finger, the changes of these, the motors, and how much of the
    episode is over, by which the hand moves. The reward of an action is the
    height of the cube above the floor in units of 50 mm, less a hundredth of the squared commands in units of 10 N;
    an episode in which the cube is above 30 mm at the end was a success."""

    def __init__(self, *, most: float = 20.0, render_mode: str | None = None, scene: SceneLike | None = None) -> None:
        names = ["left_pull", "right_front_pull", "right_back_pull"]
        super().__init__(
            scene if scene is not None else gripper_scene(),
            actions=dict.fromkeys(names, (0.0, most)),
            observed=["cube", "left", "right_front", "right_back"],
            steps=4,
            render_mode=render_mode,
        )

    worst = -0.2

    def extra(self) -> Array:
        return np.array([self._taken / self.horizon])

    def height(self) -> float:
        """[m] of the cube above the floor."""
        return float(self.state.bodies["cube"].position[2]) - 0.01

    def reward(self) -> tuple[float, bool]:
        effort = float(np.square(self._command / 10.0).sum())
        return self.height() / 0.05 - 0.01 * effort, False

    def step(self, action: npt.NDArray[np.float32]) -> tuple[Array, float, bool, bool, dict[str, Any]]:
        seen, value, done, truncated, info = super().step(action)
        info["success"] = truncated and self.height() > 0.03
        return seen, value, done, truncated, info


class ThreadVectorEnv(gymnasium.vector.SyncVectorEnv):
    """Environments beside each other whose steps are made by as many threads."""

    def __init__(self, make: Sequence[Callable[[], gymnasium.Env[Any, Any]]], threads: int | None = None, **keywords: Any):
        if not make:
            raise ValueError("there is no environment to be made")
        super().__init__(make, **keywords)
        self._pool = ThreadPoolExecutor(threads or len(self.envs))
        self.envs = [_Ahead(env) for env in self.envs]

    def step(self, actions: Any) -> Any:
        split = list(gymnasium.vector.utils.iterate(self.action_space, actions))
        resets = getattr(self, "_autoreset_envs", np.zeros(len(self.envs), dtype=bool))
        going = [(env, action) for env, action, again in zip(self.envs, split, resets, strict=True) if not again]
        list(self._pool.map(lambda own: own[0].ahead(own[1]), going))
        return super().step(actions)

    def close_extras(self, **keywords: Any) -> None:
        self._pool.shutdown()
        super().close_extras(**keywords)


class _Ahead(gymnasium.Wrapper[Any, Any, Any, Any]):
    """Takes a step before it is asked for."""

    _result: Any = None

    def ahead(self, action: Any) -> None:
        self._result = self.env.step(action)

    def step(self, action: Any) -> Any:
        result, self._result = self._result, None
        return self.env.step(action) if result is None else result


gymnasium.register(id="sinew/Reach-v0", entry_point="sinew.envs:ReachEnv")
gymnasium.register(id="sinew/Grasp-v0", entry_point="sinew.envs:GraspEnv")
