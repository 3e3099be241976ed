# SPDX-License-Identifier: BSD-3-Clause
"""Networks of plain layers, which play by numpy alone: for one robot in a tenth of the time of a call of torch."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from ..errors import AgentError
from .features import Rows

ACTIVATIONS: dict[str, Callable[[Rows], Rows]] = {
    "": lambda rows: rows,
    "tanh": np.tanh,
    "relu": lambda rows: np.maximum(rows, np.float32(0.0)),
}
"""What is done with a layer's sums, by name."""


class Layer(NamedTuple):
    """One layer."""

    weight: Rows
    """Shape (outputs, inputs)."""
    bias: Rows
    """Shape (outputs,)."""
    activation: str
    """A name of ``ACTIVATIONS``."""


class Network:
    """Greedy choices.

    Args:
        layers: its layers, the first one first.
        chooses: whether the greatest output is the number of an action; else outputs are numbers of actions.
    """

    def __init__(self, layers: Sequence[Layer], chooses: bool) -> None:
        self.layers, self.chooses = tuple(layers), chooses

    def __call__(self, rows: Rows) -> npt.NDArray[Any]:
        """The best actions for rows of features: their numbers, or numbers from -1 to 1. How many rows there are
        changes nothing in one."""
        for weight, bias, activation in self.layers:
            rows = ACTIVATIONS[activation]((weight @ rows[:, :, None])[:, :, 0] + bias)  # row by row
        return np.argmax(rows, axis=1) if self.chooses else np.clip(rows, -1.0, 1.0)


def network_of(model: Any) -> Network:
    """The network of a model of stable-baselines3: DQN, PPO or SAC with plain layers.

    Raises:
        AgentError: its layers are others.
    """
    policy = model.policy
    if hasattr(policy, "q_net"):
        stages = [*policy.q_net.q_net]
    elif hasattr(policy, "mlp_extractor"):
        stages = [*policy.mlp_extractor.policy_net, policy.action_net]
    else:
        stages = [*policy.actor.latent_pi, policy.actor.mu]
    layers: list[Layer] = []
    for stage in stages:
        kind = type(stage).__name__
        if kind == "Linear":
            layers.append(Layer(stage.weight.detach().numpy().copy(), stage.bias.detach().numpy().copy(), ""))
        elif kind.lower() in ACTIVATIONS and layers:
            layers[-1] = layers[-1]._replace(activation=kind.lower())
        else:
            raise AgentError(f"a layer {stage} cannot be played")
    if hasattr(policy, "actor"):
        layers[-1] = layers[-1]._replace(activation="tanh")
    return Network(layers, hasattr(model.action_space, "n"))
