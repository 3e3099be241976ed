# SPDX-License-Identifier: BSD-3-Clause
"""What every page does with its users' wishes: whatever becomes of one, the vehicle and the page go on."""

from __future__ import annotations

import traceback
from collections.abc import Callable
from typing import Any

from ..errors import SitlError
from . import page_library


class Guard:
    """Runs what browsers ask for, and shows them what went wrong."""

    server: Any
    """Of viser."""

    def guarded(self, act: Callable[[Any], None]) -> Callable[[Any], None]:
        """``act`` on an event of the page; an error is shown to who caused it."""

        def run(event: Any) -> None:
            self.safely(lambda: act(event), getattr(event, "client", None))

        return run

    def safely(self, act: Callable[[], None], client: Any = None) -> None:
        """Do something; an error is shown in the browser that asked for it, or in all (None). One that is not a user's
        mistake is printed, too."""
        try:
            act()
        except SitlError as error:
            self.notify(str(error), client)
        except Exception as error:
            traceback.print_exc()
            self.notify(f"an error of the page: {type(error).__name__}: {error}", client)

    def notify(self, text: str, client: Any = None, title: str = "Not done") -> None:
        """Show a note in one browser, or in all (None)."""
        for each in [client] if client is not None else self.server.get_clients().values():
            page_library.note(each, text, title)
