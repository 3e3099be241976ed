# SPDX-License-Identifier: BSD-3-Clause
"""What is rehearsed: the folder of a run, of several seeds, or a policy alone, as a file or by a baseline's name."""

from __future__ import annotations

from pathlib import Path

from sitl.errors import did_you_mean

from .. import baselines, learnt
from ..deep import policy_file
from ..errors import AgentError
from ..report.group import Group
from ..runs import folder as folders
from ..runs.episodes import EpisodeLog
from ..runs.folder import RunFolder


class PolicyRun(RunFolder):
    """A policy of a file, as a run without episodes: the file says in which environment it was learnt.

    Args:
        path: of the file, as ``sitl export`` writes it.

    Raises:
        AgentError: it is none, or reaches outside of this process and the user has not said so.
    """

    def __init__(self, path: str | Path) -> None:
        self.path = Path(path)
        self.config = learnt.load(self.path).config
        self.episodes = EpisodeLog(self.path.with_suffix("") / "episodes.csv")


def run_of(path: Path) -> RunFolder:
    """The run of a folder or of a policy's file."""
    return PolicyRun(path) if path.suffix == policy_file.SUFFIX else RunFolder(path)


def group_of(path: Path, name: str) -> Group:
    """What a user names: a run, a folder of its seeds, a policy's file, or a baseline.

    Args:
        path: of the folder or the file, or a baseline's name.
        name: in tables and pictures.

    Raises:
        AgentError: it is none of these.
    """
    found = baselines.find(str(path))
    if found.suffix == policy_file.SUFFIX:
        return Group(name, [PolicyRun(found)])
    if not found.exists():
        hint = did_you_mean(str(path), baselines.names())
        raise AgentError(
            f"{path} is not there: a run's folder, a folder of several seeds, a policy's file {policy_file.SUFFIX} or "
            f"the name of a baseline is needed{hint}"
        )
    return Group(name, folders.find(found))
