# SPDX-License-Identifier: BSD-3-Clause
"""What reaches a flight, an observation, a task, a world or a policy's action has the same bits on any machine: there
``sitl.core.elementary`` (of arrays: ``elementary_arrays``) and ``sitl.core.sums`` are used, nothing else."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import pytest

from .inexact import uses

ROOT = Path(__file__).resolve().parents[1]


class Exception_(NamedTuple):
    """Where other arithmetic may be used."""

    where: str
    """A file, or a folder with all below it."""
    what: str
    """As ``inexact.uses`` names it; "*": anything."""
    why: str


EXCEPTIONS = [
    Exception_("sitl/view", "*", "drawings on a page"),
    Exception_("sitl/envs/page", "*", "drawings on a page"),
    Exception_("sitl/envs/rendering.py", "*", "pictures for people"),
    Exception_("sitl/worlds/drawing.py", "*", "pictures for people"),
    Exception_("sitl/logs/plot.py", "*", "pictures for people"),
    Exception_("sitl/missions/comparison/plots.py", "*", "pictures for people"),
    Exception_("sitl/cli", "*", "what is printed"),
    Exception_("sitl/agents/cli", "*", "what is printed"),
    Exception_("sitl/agents/runs/bar.py", "*", "what is printed"),
    Exception_("sitl/examples", "*", "programs of users, which may depend on nothing of ours"),
    Exception_("sitl/physics/pybullet", "*", "Bullet computes by the C library, too; its flights have tolerances"),
    Exception_("sitl/physics/jsbsim", "*", "JSBSim computes by the C library, too; its flights have tolerances"),
    Exception_("sitl/agents/report", "*", "tables and intervals of trainings, by SciPy"),
    Exception_("sitl/identify", "*", "properties of an airframe from its logs, by SciPy: an estimate, kept as a file"),
    Exception_("sitl/agents/deep/checkpoint.py", "*", "training by torch, which repeats on one machine"),
    Exception_("sitl/agents/deep/onnx_file.py", "*", "a file for runtimes that compute as they like"),
    Exception_("sitl/envs/noise.py", ".standard_normal()", "where its tails are drawn anew"),
    Exception_("sitl/envs/noise.py", ".standard_exponential()", "where its tails are drawn anew"),
    Exception_("sitl/bridge/wire/choose.py", "hash()", "a file's name in tracebacks"),
    Exception_("sitl/missions/testing/factory.py", "hash()", "whether there is one"),
    Exception_("sitl/envs/robots/starts.py", "hash()", "a key of a dictionary whose order nothing depends on"),
    *(
        Exception_(where, "sum()", "of whole numbers")
        for where in (
            "sitl/agents/evaluate.py",
            "sitl/agents/runs/training.py",
            "sitl/agents/tabular/training.py",
            "sitl/bridge/dialect.py",
            "sitl/bridge/hil/sensor.py",
            "sitl/bridge/telemetry/high_latency.py",
            "sitl/missions/cli/replay.py",
            "sitl/missions/comparison/report.py",
            "sitl/missions/testing/factory.py",
        )
    ),
    Exception_("sitl/core/build_work.py", "sum()", "progress that is shown"),
    Exception_("sitl/missions/suite/run.py", "sum()", "what is printed"),
    Exception_("sitl/logs/dataflash/derived.py", "sum()", "of columns"),
]


def _holds(exception: Exception_, path: str, what: str) -> bool:
    is_there = path == exception.where or path.startswith(exception.where + "/")
    return is_there and exception.what in ("*", what)


def test_nothing_that_must_repeat_depends_on_the_machine() -> None:
    found = [
        (str(path.relative_to(ROOT)), use) for path in sorted((ROOT / "sitl").rglob("*.py"))
        for use in uses(path.read_text(encoding="utf-8"))
    ]  # fmt: skip
    others = [
        f"{path}:{use.line}: {use.what}" for path, use in found
        if not any(_holds(exception, path, use.what) for exception in EXCEPTIONS)
    ]  # fmt: skip
    assert not others, "\n".join(others)
    idle = [e for e in EXCEPTIONS if not any(_holds(e, path, use.what) for path, use in found)]
    assert not idle, f"no longer needed: {idle}"


@pytest.mark.parametrize(
    "source, what",
    [
        ("import math\nmath.sin(x)", "math.sin"),
        ("import math as m\nm.hypot(x, y)", "math.hypot"),
        ("import math\nf = math.dist", "math.dist"),
        ("import math\nmath.sumprod(x, y)", "math.sumprod"),
        ("from math import cos", "math.cos"),
        ("from math import exp as e", "math.exp"),
        ("import cmath", "cmath"),
        ("import numpy as np\nnp.hypot(x, y)", "np.hypot"),
        ("import numpy\nnumpy.arctan2(x, y)", "np.arctan2"),
        ("import numpy as np\nnp.linalg.norm(x)", "np.linalg"),
        ("import numpy.linalg", "numpy.linalg"),
        ("from numpy.linalg import norm", "np.linalg"),
        ("from numpy import linalg", "np.linalg"),
        ("from numpy import tanh", "np.tanh"),
        ("import numpy as np\nnp.einsum('i,i', x, y)", "np.einsum"),
        ("import numpy as np\nnp.power(x, y)", "np.power"),
        ("a @ b", "@"),
        ("a @= b", "@"),
        ("a.dot(b)", ".dot()"),
        ("a ** 2", "**"),
        ("a **= 0.5", "**"),
        ("10.0 ** -k", "**"),
        ("1.5 ** 2", "**"),
        ("pow(a, b)", "pow()"),
        ("sum(x * y for x, y in pairs)", "sum()"),
        ("sum(lengths)", "sum()"),
        ("hash('a')", "hash()"),
        ("complex(a, b)", "complex()"),
        ("1j * a", "complex"),
        ("rng.normal()", ".normal()"),
        ("np.random.default_rng(1).standard_normal(3)", ".standard_normal()"),
        ("import numpy as np\nnp.argsort(a)", ".argsort()"),
        ("a.argsort()", ".argsort()"),
        ("import random", "random"),
        ("from random import gauss", "random.gauss"),
        ("import statistics", "statistics"),
        ("from scipy import stats", "scipy.stats"),
    ],
)
def test_what_depends_on_the_machine_is_found(source: str, what: str) -> None:
    assert [use.what for use in uses(source)] == [what]


@pytest.mark.parametrize(
    "source",
    [
        "import math\nmath.sqrt(x) + math.fmod(x, y) + math.radians(x) + math.pi + math.fsum(x)",
        "from math import sqrt, floor",
        "import numpy as np\nnp.sqrt(x) + np.square(x).sum() + np.cumsum(x) + np.mean(x) + np.interp(x, a, b)",
        "from sitl.core.elementary import sin, pow\nsin(x) + pow(x, y)",
        "from sitl.core import rng\nrng.normal(v.rng)",
        "2**31 + 10**15 + 2.0**-54",
        "sum(len(x) for x in rows) + sum(map(len, rows)) + sum(1 for x in rows if x) + sum(x > 0.0 for x in rows)",
        "generator.uniform(0.0, 1.0) + generator.random() + generator.integers(3)",
        "import numpy as np\nnp.argsort(a, kind='stable')",
    ],
)
def test_what_is_the_same_everywhere_is_not_found(source: str) -> None:
    assert uses(source) == []
