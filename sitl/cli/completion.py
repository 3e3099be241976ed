# SPDX-License-Identifier: BSD-3-Clause
"""``sitl completion``: what makes a shell complete the words of the command."""

from __future__ import annotations

import argparse

from argcomplete import shellcode

SHELLS = ("bash", "zsh", "fish")
PROGRAM = "sitl"


def add_parser(commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Declare the command."""
    parser = commands.add_parser(
        "completion",
        epilog='bash and zsh: eval "$(sitl completion bash)" in ~/.bashrc or ~/.zshrc (zsh: the word zsh). '
        "fish: sitl completion fish > ~/.config/fish/completions/sitl.fish",
    )
    parser.add_argument("shell", choices=SHELLS)
    parser.set_defaults(function=completion)


def completion(options: argparse.Namespace) -> int:
    """Print the shell's code."""
    print(shellcode([PROGRAM], shell=options.shell))
    return 0
