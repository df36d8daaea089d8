"""Learning without a library: the cross-entropy method finds how hard to pull for each goal."""

import numpy as np
import numpy.typing as npt

from sinew.envs import ReachEnv

env = ReachEnv()


def episode(gains: npt.NDArray[np.float64], seed: int) -> tuple[float, float]:
    """Sum of rewards, and the distance at the end, of pulls in proportion to where the goal is."""
    seen, _ = env.reset(seed=seed)
    goal, total, distance = seen[-3:], 0.0, 0.0
    sides = np.array([goal[1], goal[2], -goal[1], -goal[2]])
    action = np.clip(gains[0] + gains[1] * sides, -1, 1).astype(np.float32)
    for _ in range(15):
        seen, reward, _, truncated, info = env.step(action)
        total += float(reward)
        distance = float(info["distance"])
        if truncated:
            break
    return total, distance


random = np.random.default_rng(0)
mean, spread = np.array([-1.0, 0.0]), np.array([0.5, 20.0])
first = np.mean([episode(mean, seed)[1] for seed in range(100, 103)])
for turn in range(4):
    tried = mean + spread * random.standard_normal((10, 2))
    scores = [np.mean([episode(gains, seed)[0] for seed in range(2)]) for gains in tried]
    best = tried[np.argsort(scores)[-3:]]
    mean, spread = best.mean(axis=0), best.std(axis=0) + 1e-3
    print(f"turn {turn}: best {max(scores):.1f}")
last = np.mean([episode(mean, seed)[1] for seed in range(100, 103)])
print(f"distance at the end, new goals: {1e3 * first:.1f} mm before, {1e3 * last:.1f} mm after")
assert last < 0.5 * first
