# SPDX-License-Identifier: BSD-3-Clause
"""Run folders, and what is kept while a run is trained.

The folder of a run, and folders of several runs.

A run has config.json (what it is), episodes.csv (what came of it), a model, curve.png. A folder whose subfolders are
runs is a group: the same run with several seeds.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Container, Iterable
from pathlib import Path

from sitl.core import code_in_files

from ..errors import AgentError
from .config import RunConfig
from .episodes import Episode, EpisodeLog
from .files import make_folder
from .watch import Watch

CONFIG = "config.json"
ENOUGH = "enough"
"""File that is there when a run has ended before its length, because it had learnt enough."""


class RunFolder:
    """The folder of a run.

    Args:
        path: path of the folder, which has a config.json.
        replaced: options of its environment in whose place others come (``RunConfig.load``).

    Raises:
        AgentError: it has none.
    """

    def __init__(self, path: str | Path, replaced: Container[str] = ()) -> None:
        self.path = Path(path)
        self.config = RunConfig.load(self.path / CONFIG, replaced)
        self.episodes = EpisodeLog(self.path / "episodes.csv")

    @classmethod
    def create(cls, path: str | Path, config: RunConfig) -> RunFolder:
        """Make the folder of a new run.

        Raises:
            AgentError: there is one already, there are runs below it or one above, or it cannot be made.
        """
        folder = Path(path)
        if (folder / CONFIG).exists():
            raise AgentError(f"{folder} is a run already; --resume goes on with it, another folder begins anew")
        if is_run(folder.parent):
            raise AgentError(f"{folder.parent} is a run already, which holds no others; choose another folder")
        if any(any(folder.glob(f"{below}/{CONFIG}")) for below in ("*", "*/*")):
            raise AgentError(f"{folder} is a folder of runs; choose another one for this run")
        make_folder(folder)
        config.save(folder / CONFIG)
        code_in_files.allow(config.code)  # the folder is this user's own
        return cls(folder)

    def extend(self, episodes: int | None, steps: int | None) -> None:
        """Set the length of a run that is resumed; None: unchanged."""
        config = self.config
        self.config = config.with_(
            episodes=config.episodes if episodes is None else episodes, steps=config.steps if steps is None else steps
        )
        if self.config != config:
            self.config.save(self.path / CONFIG)

    @classmethod
    def ensure(cls, path: str | Path, config: RunConfig) -> RunFolder:
        """The run in a folder; it is made if there is none, and extended to the length of ``config``.

        Raises:
            AgentError: another run is there, or ``create`` says.
        """
        folder = Path(path)
        if not is_run(folder):
            return cls.create(folder, config)
        run = cls(folder)
        different = run.config.differences(config)
        if different:
            raise AgentError(f"{folder} differs in {', '.join(different)}; choose another --out")
        run.extend(_longer(run.config.episodes, config.episodes), _longer(run.config.steps, config.steps))
        return run

    @property
    def name(self) -> str:
        """Name of the folder."""
        return self.path.name


def _longer(there: int | None, requested: int | None) -> int | None:
    return requested if there is None or requested is None else max(there, requested)


def is_run(path: Path) -> bool:
    """Whether a folder is a run."""
    return (path / CONFIG).is_file()


def find(path: str | Path) -> list[RunFolder]:
    """The run in a folder, or the runs of a group, by seed.

    Raises:
        AgentError: there is none.
    """
    folder = Path(path)
    if is_run(folder):
        return [RunFolder(folder)]
    runs = [RunFolder(p) for p in folder.iterdir() if is_run(p)] if folder.is_dir() else []
    if not runs:
        raise AgentError(f"{folder} is neither a run nor a folder of runs")
    return sorted(runs, key=lambda run: (run.config.seed, run.name))


def seed_folder(path: Path, seed: int) -> Path:
    """Folder of the run with a seed, in a group."""
    return path / f"seed-{seed}"


def common(runs: Iterable[RunFolder]) -> RunConfig:
    """Configuration that the runs of a group share, with the first one's seed.

    Raises:
        AgentError: they differ in more than the seed.
    """
    first, *others = runs
    for other in others:
        different = [name for name in first.config.differences(other.config) if name != "seed"]
        if different:
            raise AgentError(f"{first.path} and {other.path} are not one group: they differ in {', '.join(different)}")
    return first.config


PERIOD_S = 5.0
"""Wall time between checkpoints [s]."""
_FIRST_S = 0.5
"""Wall time until the first checkpoint [s]."""
_REPORT_S = 0.1
"""Wall time between reports to ``watch`` [s]."""


class Keeper:
    """Collects episodes as they are done.

    Args:
        folder: folder of the run.
        watch: receives them.
        checkpoint: saves the model; called when it has learnt from all episodes collected so far.
    """

    def __init__(self, folder: RunFolder, watch: Watch, checkpoint: Callable[[], None]) -> None:
        self._folder, self._watch, self._checkpoint = folder, watch, checkpoint
        self._unwritten: list[Episode] = []
        self._unreported: list[Episode] = []
        self._reported_at = time.monotonic()
        self._saved = self._reported_at - PERIOD_S + _FIRST_S

    def take(self, row: Episode) -> None:
        """An episode is done."""
        self._unwritten.append(row)
        self._unreported.append(row)
        now = time.monotonic()
        if now - self._reported_at > _REPORT_S:
            self._report()
        if now - self._saved > PERIOD_S:
            self.save()

    def save(self) -> None:
        """Write new episodes to the log, then the checkpoint: a log may be ahead of its model, never behind."""
        if self._unreported:
            self._report()
        self._folder.episodes.append(self._unwritten)
        self._unwritten = []
        self._checkpoint()
        self._saved = time.monotonic()

    def _report(self) -> None:
        self._watch.on_progress(self._unreported)
        self._unreported = []
        self._reported_at = time.monotonic()
