# SPDX-License-Identifier: BSD-3-Clause
"""Laws that build and take messages, chosen by the message's number.

A law that builds a message takes the message and the vehicle, and says whether there is something to say::

    @law
    def attitude(m: Attitude, v: Vehicle) -> bool: ...

It may take the port as a third argument (``port.epoch_us``, ``port.part``). A law that takes a message gets the
message, the vehicle and the sender's system id.
"""

from __future__ import annotations

import linecache
from collections.abc import Callable, Iterable
from functools import cache
from typing import Any, get_type_hints

from ...core.kernels import law
from ...core.memory import record_at
from .message import Message

Builder = Callable[..., bool]
"""``law(m, v)`` or ``law(m, v, port)``."""
Taker = Callable[..., None]
"""``law(m, v, sender)``."""


@cache  # every new bridge asks for that of each law
def message_of(function: Callable[..., Any]) -> type[Message]:
    """The message that a law builds or takes: the class of its first argument.

    Raises:
        TypeError: it is none.
    """
    first = function.__code__.co_varnames[0]
    found = get_type_hints(function).get(first)
    if not (isinstance(found, type) and issubclass(found, Message)):
        raise TypeError(f"{function.__module__}.{function.__qualname__}: its first argument is no Message")
    return found


def choose_builder(builders: Iterable[Builder]) -> Callable[[int, Any, Any, int], bool]:
    """A law ``build(number, v, port, address)``: writes the payload of a message to an address.

    False when the vehicle has nothing to say, or none of ``builders`` builds the message.
    """
    build: Callable[[int, Any, Any, int], bool] = _choose("build", "port", builders, "return ", "    return False\n")
    return build


def choose_taker(takers: Iterable[Taker]) -> Callable[[int, Any, int, int], bool]:
    """A law ``take(number, v, sender, address)``: acts on the message whose payload is at an address.

    False when none of ``takers`` takes it.
    """
    take: Callable[[int, Any, int, int], bool] = _choose("take", "sender", takers, "", "    return False\n")
    return take


def choose_targets(takers: Iterable[Taker]) -> Callable[[int], int]:
    """A law ``target(number)``: offset of target_system in the payload of a message that ``takers`` take; -1: none."""
    lines = ["def target(number):\n"]
    for function in takers:
        kind = message_of(function).kind
        if "target_system" in kind.fields:
            lines += [f"    if number == {kind.id}:\n", f"        return {kind.offset_of('target_system')}\n"]
    target: Callable[[int], int] = _made("target", [*lines, "    return -1\n"], {})
    return target


def _choose(name: str, third: str, laws: Iterable[Callable[..., Any]], result: str, end: str) -> Any:
    names: dict[str, Any] = {"record_at": record_at}
    lines = [f"def {name}(number, v, {third}, address):\n"]
    for function in laws:
        cls = message_of(function)
        number = cls.kind.id
        names[f"law_{number}"], names[f"message_{number}"] = function, cls
        more = f", {third}" if function.__code__.co_argcount == 3 else ""
        lines.append(f"    if number == {number}:\n")
        lines.append(f"        {result}law_{number}(record_at(message_{number}, address), v{more})\n")
        if not result:
            lines.append("        return True\n")
    return _made(name, [*lines, end], names)


def _made(name: str, lines: list[str], names: dict[str, Any]) -> Any:
    text = "".join(lines)
    file = f"<{name} {abs(hash(text))}>"
    linecache.cache[file] = (len(text), None, text.splitlines(keepends=True), file)  # for Numba's messages
    names["__name__"] = __name__
    exec(compile(text, file, "exec"), names)
    return law(names[name])
