# SPDX-License-Identifier: BSD-3-Clause
"""``--view`` of ``sitl train``: clips of the environment that is being learnt in."""

from __future__ import annotations

import argparse
import contextlib
from collections.abc import Callable, Iterator
from typing import Any

from sitl.cli.view_options import offered, wants_view
from sitl.envs.navigate import Navigate
from sitl.envs.page.watchers import InClips
from sitl.envs.vector import NavigateVector

from ..errors import AgentError
from ..runs.watch import Shows


@contextlib.contextmanager
def shown_training(options: argparse.Namespace) -> Iterator[Shows | None]:
    """What shows the environments of runs, one after another, while the block runs; None: nobody asked for it.

    Raises:
        MissingExtra, OptionError, sitl.view.page.PageAddressError, sitl.view.gate.GateError: see ``view_options``.
    """
    if not wants_view(options):
        yield None
        return
    from sitl.envs.page.page import EnvPage

    with contextlib.ExitStack() as stack:

        def shows(env: Any) -> Callable[[], bool]:
            stack.close()  # the run before is over
            inner = env.unwrapped
            if not isinstance(inner, Navigate | NavigateVector):
                raise AgentError(f"--view: {type(inner).__name__} has no robots of this package to show")
            port = 0 if options.view_address is not None else options.view_port
            page = EnvPage(inner.session, getattr(env.spec, "id", inner.robot.name), port)
            stack.enter_context(offered(page, options))
            watcher = InClips(page, inner.step_time)
            stack.callback(watcher.close)
            inner.watch(watcher)
            return watcher.wants_steps

        yield shows
