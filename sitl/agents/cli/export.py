# SPDX-License-Identifier: BSD-3-Clause
"""``sitl export``: what a run has learnt as one small file."""

from __future__ import annotations

import argparse
from pathlib import Path

from .. import learnt
from ..runs import folder as folders
from .agent_options import add_said_again


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Declare the command."""
    parser = commands.add_parser(
        "export",
        description="Writes the policy network of a run: .npz for sitl and NumPy, .onnx in other programs.",
    )
    parser.add_argument("run", type=Path, metavar="RUN", help="run folder; of several runs the first is written")
    parser.add_argument("file", type=Path, metavar="FILE", help=".npz or .onnx")
    add_said_again(parser)
    parser.set_defaults(function=export)


def export(options: argparse.Namespace) -> int:
    """Run the command."""
    learnt.save(folders.find(options.run)[0], options.file)
    print(f"{options.file}: {options.file.stat().st_size:,} bytes")
    return 0
