# SPDX-License-Identifier: BSD-3-Clause
"""What an agent can see: colour and depth pictures of a copter that flies through a forest.

Pictures are parts of an observation, as numbers are; they come from the same rays as lidars do, without a GPU.

    python examples/camera_views.py

It draws camera_views.png and needs matplotlib.
"""

import gymnasium as gym

from sitl.envs.pictures import Camera, Depth

try:
    import matplotlib.pyplot as plt
except ModuleNotFoundError as error:
    raise SystemExit(f"{error.name} is missing: pip install matplotlib") from None

CAMERAS = {"colour": Camera(160, 120), "depth": Depth(160, 120, reach=15)}
STEPS = (0, 30, 60)
"""Steps of 0.1 s after which pictures are shown."""


def main() -> None:
    """Fly ahead, and draw what is seen on the way."""
    env = gym.make("sitl.envs:sitl/CopterForest-v1", world="forest:seed=7", observation=CAMERAS)
    observation, _ = env.reset(seed=1)
    figure, rows = plt.subplots(len(CAMERAS), len(STEPS), figsize=(8, 4), layout="constrained")
    step = 0
    for column, stop in enumerate(STEPS):
        while step < stop:
            observation, _, terminated, _, _ = env.step([1.0, 0.0, 0.0, 0.1])  # ahead, left, up, turn: -1 .. 1
            assert not terminated, f"the episode ended in step {step}"
            step += 1
        print(f"{0.1 * step:.1f} s: the nearest tree is {observation['depth'][:50].min():.1f} m away")
        for axes, (name, picture) in zip(rows[:, column], observation.items()):
            shown = axes.imshow(picture, cmap="viridis_r", vmin=0)
            axes.set(xticks=[], yticks=[], title=f"{name}, {0.1 * step:.0f} s")
    figure.colorbar(shown, ax=rows[1], label="m")
    figure.savefig("camera_views.png", dpi=80)


if __name__ == "__main__":
    main()
