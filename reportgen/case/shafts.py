"""The shafts of an assignment: their speeds and senses of rotation."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Shaft:
    """A shaft of a work: what it is called, its speed (rad/s) if it is known, and its sense, 1 or −1.

    A `fixed` sense is counted anticlockwise as the machine is drawn, any other one from shaft to shaft of the same
    work.  `datum` is the key of the parameters that gives its speed; what is chosen may miss the speed by a `share`.
    """

    name: str
    speed: float | None
    turn: int
    fixed: bool = False
    datum: str = ""
    share: float = 0.0
