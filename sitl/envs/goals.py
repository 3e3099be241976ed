# SPDX-License-Identifier: BSD-3-Clause
"""Goal-conditioned environments as ``gymnasium.make`` gives them: what it returns has ``compute_reward``.

Wrappers of Gymnasium 1 do not pass attributes on, and libraries call ``env.compute_reward`` on the outermost one, as
Gymnasium-Robotics once documented it; stable-baselines3's ``check_env`` does.
"""

from __future__ import annotations

from collections.abc import Callable
from copy import copy
from typing import Any

import gymnasium as gym
from gymnasium.envs.registration import EnvSpec, WrapperSpec
from gymnasium.utils import RecordConstructorArgs


class ForSingle(tuple[WrapperSpec, ...]):
    """Wrappers of single environments alone: ``gymnasium.make`` applies them, and ``gymnasium.make_vec``, which asks
    only how many there are, makes vector environments by their own entry point as if there were none."""

    def __len__(self) -> int:
        return 0

    def __bool__(self) -> bool:
        return False


class Goals(gym.Wrapper[Any, Any, Any, Any], RecordConstructorArgs):
    """Passes ``compute_reward`` on, and changes nothing."""

    def __init__(self, env: gym.Env[Any, Any]) -> None:
        RecordConstructorArgs.__init__(self)
        gym.Wrapper.__init__(self, env)

    @property
    def compute_reward(self) -> Callable[[Any, Any, Any], Any]:
        """See ``Navigate.compute_reward``."""
        found: Callable[[Any, Any, Any], Any] = self.env.get_wrapper_attr("compute_reward")
        return found

    @property
    def spec(self) -> EnvSpec | None:  # type: ignore[override]
        """That of the environment within, which makes this wrapper, too."""
        spec = copy(self.env.spec)  # the other one is kept by the wrapper within
        if spec is not None:
            spec.additional_wrappers = ForSingle((*spec.additional_wrappers, WRAPPER))
        return spec


WRAPPER = WrapperSpec("Goals", "sitl.envs.goals:Goals", {})
