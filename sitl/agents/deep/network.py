# SPDX-License-Identifier: BSD-3-Clause
"""Networks of plain layers, which play without torch: for one robot in less than a tenth of the time of its call, and
with the same bits on any processor."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from ..errors import AgentError
from . import layers
from .features import Rows

ACTIVATIONS = {"": layers.PLAIN, "tanh": layers.TANH, "relu": layers.RELU}
"""What is done with a layer's sums, by name: as laws of ``layers`` call it."""


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
        stages: its layers, the first one first.
        chooses: whether the greatest output is the number of an action; else outputs are numbers of actions.

    Raises:
        AgentError: a layer does not fit the one before it.
    """

    def __init__(self, stages: Sequence[Layer], chooses: bool) -> None:
        self.layers, self.chooses = tuple(stages), chooses
        self._stages = [
            (
                np.ascontiguousarray(weight.T, np.float32),
                np.ascontiguousarray(bias, np.float32),
                ACTIVATIONS[activation],
            )
            for weight, bias, activation in self.layers
        ]
        width = len(self._stages[0][0]) if self._stages else 0
        for k, (weights, bias, _) in enumerate(self._stages):
            if weights.shape != (width, len(bias)):
                raise AgentError(
                    f"layer {k} has weights of shape {weights.T.shape} and {len(bias)} biases, for {width} numbers"
                )
            width = len(bias)

    def __call__(self, rows: Rows) -> npt.NDArray[Any]:
        """The best actions for rows of features: their numbers, or numbers from -1 to 1. How many rows there are
        changes nothing in one.

        Raises:
            AgentError: there are more features, or fewer.
        """
        rows = np.ascontiguousarray(rows, np.float32)
        width = len(self._stages[0][0]) if self._stages else rows.shape[1]
        if rows.shape[1] != width:
            raise AgentError(f"the network takes {width} features, not {rows.shape[1]}")
        run_layer = layers.layer.unchecked()
        for weights, bias, activation in self._stages:
            out = np.empty((len(rows), len(bias)), np.float32)
            run_layer(weights, bias, activation, rows, out)
            rows = out
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
    found: list[Layer] = []
    for stage in stages:
        kind = type(stage).__name__
        if kind == "Linear":
            found.append(Layer(stage.weight.detach().numpy().copy(), stage.bias.detach().numpy().copy(), ""))
        elif kind.lower() in ACTIVATIONS and found:
            found[-1] = found[-1]._replace(activation=kind.lower())
        else:
            raise AgentError(f"a layer {stage} cannot be played")
    if hasattr(policy, "actor"):
        found[-1] = found[-1]._replace(activation="tanh")
    return Network(found, hasattr(model.action_space, "n"))
