# SPDX-License-Identifier: BSD-3-Clause
"""A learnt network as ONNX (https://onnx.ai/onnx/intro/concepts.html), for programs that know nothing of this one.

The graph takes ``observations``, float32 of shape (robots, frames * numbers): the last observations in a row, the
newest first, in the units that the environment gives. It returns ``actions``: numbers from -1 to 1, shape (robots,
width), or numbers of a table, int64 of shape (robots,). What else is to be known is in the model's metadata.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np

from sitl.errors import MissingExtra

from ..errors import AgentError
from ..runs.files import write_bytes
from .policy import DeepPolicy
from .spaces import described

SUFFIX = ".onnx"
OPSET, IR_VERSION = 17, 8
"""Versions that runtimes of 2022 and later read."""


def write(path: Path, policy: DeepPolicy, about: Mapping[str, Any]) -> None:
    """Write a policy; see ``policy_file.write``.

    Raises:
        AgentError: its observations are none of numbers in a row, or the file cannot be written.
        MissingExtra: onnx is not installed.
    """
    try:
        import onnx
        from onnx import TensorProto, helper, numpy_helper
    except ModuleNotFoundError:
        raise MissingExtra("writing .onnx needs onnx: pip install 'gym-sitl[onnx]'") from None
    space = policy.features.space
    if not isinstance(space, gym.spaces.Box) or policy.features.width != int(np.prod(space.shape)):
        raise AgentError(
            f"{path}: what the policy sees, {policy.features.width} features of {space}, has no graph yet; write .npz"
        )
    network, width = policy.network, policy.features.width * policy.settings.frames
    outputs = len(network.layers[-1].bias)
    nodes, weights, name = _features(helper, numpy_helper, space)
    for k, layer in enumerate(network.layers):
        weights += [
            numpy_helper.from_array(layer.weight, f"weight{k}"),
            numpy_helper.from_array(layer.bias, f"bias{k}"),
        ]
        nodes.append(helper.make_node("Gemm", [name, f"weight{k}", f"bias{k}"], [f"sum{k}"], transB=1))
        name = f"sum{k}"
        if layer.activation:
            nodes.append(helper.make_node(layer.activation.capitalize(), [name], [f"out{k}"]))
            name = f"out{k}"
    if network.chooses:
        nodes.append(helper.make_node("ArgMax", [name], ["actions"], axis=1, keepdims=0))
        result = helper.make_tensor_value_info("actions", TensorProto.INT64, ["robots"])
    else:
        weights += [numpy_helper.from_array(np.array(limit, np.float32), f"limit{limit}") for limit in (-1, 1)]
        nodes.append(helper.make_node("Clip", [name, "limit-1", "limit1"], ["actions"]))
        result = helper.make_tensor_value_info("actions", TensorProto.FLOAT, ["robots", outputs])
    given = helper.make_tensor_value_info("observations", TensorProto.FLOAT, ["robots", width])
    graph = helper.make_graph(nodes, "policy", [given], [result], weights)
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", OPSET)], producer_name="gym-sitl")
    model.ir_version = IR_VERSION
    spaces = {"observations": described(space), "actions": described(policy.actions.environment)}
    kept = {**about, "frames": policy.settings.frames, **spaces}
    helper.set_model_props(model, {key: json.dumps(value) for key, value in kept.items()})
    onnx.checker.check_model(model)
    write_bytes(path, model.SerializeToString())


def _features(helper: Any, numpy_helper: Any, space: gym.spaces.Box) -> tuple[list[Any], list[Any], str]:
    """Nodes and numbers that make features of observations (``features.Features``), and the name of the last."""
    one = numpy_helper.from_array(np.ones(1, np.float32), "one")
    node = helper.make_node
    if bool(np.any(space.low < 0.0)):
        nodes = [
            node("Abs", ["observations"], ["size"]), node("Add", ["size", "one"], ["more"]),
            node("Log", ["more"], ["log"]), node("Sign", ["observations"], ["sign"]),
            node("Mul", ["sign", "log"], ["features"]),
        ]  # fmt: skip
        return nodes, [one], "features"
    scale = numpy_helper.from_array(np.array([1.0 / np.log1p(float(space.high.max()))], np.float32), "scale")
    nodes = [
        node("Add", ["observations", "one"], ["more"]), node("Log", ["more"], ["log"]),
        node("Mul", ["log", "scale"], ["features"]),
    ]  # fmt: skip
    return nodes, [one, scale], "features"
