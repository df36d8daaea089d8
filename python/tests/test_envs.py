"""Gymnasium environments."""

from __future__ import annotations

import multiprocessing
import warnings
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor

import gymnasium
import numpy as np
import pytest
from conftest import EXAMPLES
from gymnasium.utils.env_checker import check_env

import sinew
from sinew import envs

TASKS = [envs.ReachEnv, envs.GraspEnv]


@pytest.mark.parametrize("name", ["sinew/Reach-v0", "sinew/Grasp-v0"])
def test_gymnasiums_own_check_passes(name: str) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.filterwarnings("ignore", message=".*Box observation space m.* value is.*infinity.*")
        check_env(gymnasium.make(name, render_mode="rgb_array").unwrapped)


@pytest.mark.parametrize("name", ["sinew/Reach-v0", "sinew/Grasp-v0"])
def test_seeds_repeat_an_episode(name: str) -> None:
    seen = []
    for _ in range(2):
        env = gymnasium.make(name)
        first, _ = env.reset(seed=5)
        env.action_space.seed(5)
        path = [first]
        for _ in range(10):
            path.append(env.step(env.action_space.sample())[0])
        seen.append(np.array(path))
        env.close()
    assert (seen[0] == seen[1]).all()
    other, _ = gymnasium.make(name).reset(seed=6)
    assert (other != seen[0][0]).any() == ("Reach" in name)


@pytest.mark.parametrize("make", TASKS)
def test_random_actions_never_crash(make: Callable[..., envs.SinewEnv]) -> None:
    env, random = make(), np.random.default_rng(1)
    for seed in range(4):
        env.reset(seed=seed)
        for _ in range(env.horizon):
            seen, value, _, truncated, info = env.step(random.uniform(-1, 1, env.action_space.shape).astype(np.float32))
            assert np.isfinite(seen).all() and np.isfinite(value) and info["status"]
            if truncated:
                break


def wander(task: str, first: int, count: int) -> dict[str, int]:
    """Random episodes of a task on a small mesh: how they ended."""
    env: envs.SinewEnv = (
        envs.ReachEnv(scene=envs.trunk_scene((4, 1, 1), 4)) if task == "reach" else envs.GraspEnv(scene=envs.gripper_scene((4, 1, 1), 4))
    )
    ends: dict[str, int] = {}
    for seed in range(first, first + count):
        random = np.random.default_rng(seed)
        env.reset(seed=seed)
        info: dict[str, object] = {}
        for _ in range(env.horizon):
            seen, value, terminated, _, info = env.step(random.uniform(-1, 1, env.action_space.shape).astype(np.float32))
            assert np.isfinite(seen).all() and np.isfinite(value)
            if terminated:
                break
        ends[str(info["status"])] = ends.get(str(info["status"]), 0) + 1
    return ends


@pytest.mark.slow
@pytest.mark.parametrize("task", ["reach", "grasp"])
def test_thousands_of_random_episodes_never_crash(task: str) -> None:
    """5000 episodes of 50 actions each; those that end early say why."""
    with ProcessPoolExecutor(mp_context=multiprocessing.get_context("spawn")) as pool:
        jobs = [pool.submit(wander, task, first, 100) for first in range(0, 5000, 100)]
        ends: dict[str, int] = {}
        for job in jobs:
            for status, count in job.result().items():
                ends[status] = ends.get(status, 0) + count
    print(task, ends)
    assert sum(ends.values()) == 5000 and ends["linearized"] > 4500


def test_episodes_that_break_the_robot_are_worth_the_least() -> None:
    env = envs.SinewEnv(
        sinew.Scene.from_file(EXAMPLES / "finger.yaml", {"actuators.pull.displacement": "external", "newton": {"limit": 2}}),
        actions={"pull": (0.0, 5.0)},
        observed=["tip"],
        rate=1.0,
    )
    env.reset(seed=0)
    seen, value, terminated, truncated, info = env.step(np.ones(1, dtype=np.float32))
    assert terminated and not truncated and value == env.worst * env.horizon and info["status"] != "converged"
    assert np.isfinite(seen).all()


def test_goals_are_set_from_outside() -> None:
    env = envs.ReachEnv()
    seen, _ = env.reset(options={"goal": [0.19, 0.01, 0.02]})
    assert seen[-3:].tolist() == [0.19, 0.01, 0.02]


def test_grasping_works_and_letting_go_does_not() -> None:
    env = envs.GraspEnv()
    heights = []
    for pull in (-1.0, 0.6):
        env.reset(seed=0)
        info = {}
        for k in range(env.horizon):
            action = np.full(3, pull if k > 12 else -1.0, dtype=np.float32)
            *_, info = env.step(action)
        heights.append(env.height())
        assert info["success"] == (pull > 0)
    assert heights[0] == pytest.approx(0.0, abs=1e-4) and heights[1] > 0.04


def test_a_simple_controller_reaches() -> None:
    """Pull on the side where the goal is: nearer than without."""
    env = envs.ReachEnv()
    for seed in range(3):
        seen, _ = env.reset(seed=seed)
        goal = seen[-3:]
        before = env.distance()
        info = {}
        for _ in range(env.horizon):
            pulls = np.clip(np.array([goal[1], goal[2], -goal[1], -goal[2]]) / 0.05, 0, 1)
            *_, info = env.step((2 * pulls - 1).astype(np.float32))
        assert info["distance"] < 0.5 * before


def test_threads_see_what_one_sees() -> None:
    count = 3
    one = gymnasium.vector.SyncVectorEnv([envs.ReachEnv] * count)
    many = envs.ThreadVectorEnv([envs.ReachEnv] * count)
    random = np.random.default_rng(0)
    a, _ = one.reset(seed=3)
    b, _ = many.reset(seed=3)
    assert (a == b).all()
    for _ in range(55):  # beyond the end of an episode
        actions = random.uniform(-1, 1, (count, 4)).astype(np.float32)
        first, second = one.step(actions), many.step(actions)
        assert (first[0] == second[0]).all() and (first[1] == second[1]).all() and (first[3] == second[3]).all()
    one.close()
    many.close()


def test_bad_actions_and_scenes_are_refused() -> None:
    env = envs.ReachEnv()
    env.reset(seed=0)
    with pytest.raises(ValueError, match="action"):
        env.step(np.full(4, np.nan, dtype=np.float32))
    with pytest.raises(ValueError, match="known"):
        envs.SinewEnv(envs.trunk_scene(), actions={"pull_up": (0, 1)}, observed=["tip"])
    for wrong in ({"rate": -1}, {"steps": 0}, {"horizon": 0}, {"observed": "tip"}, {"actions": {"pull_left": (1, 0)}}):
        keywords = {"actions": {"pull_left": (0, 1)}, "observed": ["tip"], **wrong}
        with pytest.raises(ValueError):
            envs.SinewEnv(envs.trunk_scene(), **keywords)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="render_mode"):
        envs.ReachEnv(render_mode="ansi")
