# SPDX-License-Identifier: BSD-3-Clause
"""What an environment reports of its steps, and what is shown of them: all that the page can take, or clips of some."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

from sitl.cli.view_options import open_browser
from sitl.run.watched import Watched

from ..session import Session

if TYPE_CHECKING:
    from .page import EnvPage
    from .source import Captured

_LENGTH = 300
"""Steps of a clip, at most."""


class Watcher(Protocol):
    """Is notified of episodes and steps; changes nothing."""

    def started(self, index: int) -> None:
        """An episode of a robot begins."""

    def stepped(self, observations: Any) -> None:
        """A step was made; ``observations``: of all robots."""

    def close(self) -> None:
        """There will be no more steps."""


class Directly:
    """Shows the newest step as often as the page can draw, at most 30 times a second.

    Args:
        page: of the environment; it is closed with it.
        seconds: simulated time of a step [s].
    """

    def __init__(self, page: EnvPage, seconds: float) -> None:
        self.page, self._source = page, page.env_source
        self._watched = Watched(page, lambda: round(self._source.steps * seconds * 1e6))

    def started(self, index: int) -> None:
        self._source.started(index)

    def stepped(self, observations: Any) -> None:
        self._source.stepped(observations)
        self._watched()

    def close(self) -> None:
        self.page.capture(0.0)
        self.page.wait_drawn()
        self.page.close()


class InClips:
    """Takes a clip when the page wants one; else it does nothing. A clip of one robot begins with an episode.

    Args:
        page: of the environment.
        seconds: simulated time of a step [s].
    """

    def __init__(self, page: EnvPage, seconds: float) -> None:
        from sitl.view.clips import Clips

        self.page, self._source = page, page.env_source
        self.clips = Clips(page, seconds)
        self._alone = not self._source.stage.company
        self._taken: list[Captured] | None = None

    def wants_steps(self) -> bool:
        """Whether the next episode should be made step by step."""
        return self.clips.is_wanted

    def started(self, index: int) -> None:
        if index == self._source.chosen or self._alone:
            self._source.started(index)
            if self._alone:
                self._give()
                if self.clips.is_wanted:
                    self._taken = []

    def stepped(self, observations: Any) -> None:
        if self._taken is None:
            if self._alone or not self.clips.is_wanted:
                return
            self._taken = []
        self._source.stepped(observations)
        self._taken.append(self._source.capture())
        if len(self._taken) >= _LENGTH:
            self._give()

    def _give(self) -> None:
        if self._taken:
            self.clips.give(self._taken)
        self._taken = None

    def close(self) -> None:
        self.clips.close()


def opened(session: Session, name: str) -> EnvPage:
    """The page of an environment, said on the terminal, and in a browser where there is a display.

    Raises:
        MissingExtra: the library that draws it is not installed.
    """
    from .page import EnvPage

    page = EnvPage(session, name)
    print(f"page: {page.address}", flush=True)
    open_browser(page.address)
    return page
