"""The shafts of an assignment: their speeds and senses of rotation."""

from __future__ import annotations

from reportgen.base.records import Record


class Shaft(Record):
    """A shaft: its name, its speed (rad/s) if it is known, and its sense, 1 or −1.

    A `fixed` sense counts as anticlockwise in the drawing of the machine, any other one only relative to the shafts of
    the same part.  `datum` is the key of the parameters that gives the speed; a chosen design may miss the speed by a
    `share`.
    """

    name: str
    speed: float | None
    turn: int
    fixed: bool = False
    datum: str = ""
    share: float = 0.0
