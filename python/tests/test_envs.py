"""Gymnasium environments."""

from __future__ import annotations

import warnings
from collections.abc import Callable

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

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
    with pytest.raises(ValueError, match="render_mode"):
        envs.ReachEnv(render_mode="ansi")
