"""A stepped range, `{from: 80 mm, to: 120 mm, step: 5 mm}` → its values as they would be typed."""

from __future__ import annotations

import re
from collections.abc import Iterator
from decimal import Decimal

from reportgen.assignment.faults import Fault
from reportgen.assignment.source import Scalar, Table
from reportgen.units import NUMBER, QuantityFault, read_number, read_quantity, read_unit

KEYS = ("from", "to", "step")
MOST_VALUES = 10_000
_TYPED = re.compile(rf"({NUMBER})\s*(\S.*)?", re.DOTALL)
_DUST = 1e-9
"""Shares of a step below which an end counts as met: what is left of a change of units."""


def values(node: Table, faults: list[Fault]) -> tuple[Scalar, ...]:
    """from, from + step, …, up to `to` inclusive, in the unit of `from`; none if something is at fault.

    Steps are added in decimal numbers, so that 0.1 steps give 0.3.
    """
    ends = list(_ends(node, faults))
    if len(ends) < len(KEYS):
        return ()
    first = ends[0]
    unit = _unit(first.text)
    try:
        numbers = [_number(end, unit, faults) for end in ends]
    except QuantityFault:
        return ()
    start, stop, step = numbers
    if step <= 0:
        faults.append(Fault("range-step", ends[2].mark))
        return ()
    if start > stop:
        faults.append(Fault("range-order", first.mark, {"last": ends[1].text}))
        return ()
    steps = (stop - start) / step + Decimal(_DUST)
    if steps >= MOST_VALUES:
        faults.append(Fault("too-many", node.mark, {"most": str(MOST_VALUES)}))
        return ()
    return tuple(
        Scalar(f"{plain_number(start + k * step)} {unit}".strip(), first.mark) for k in range(int(steps) + 1)
    )


def plain_number(number: Decimal) -> str:
    """A decimal number without exponent and trailing zeros."""
    text = format(number.normalize(), "f")
    return "0" if text in ("-0", "0") else text


def _ends(node: Table, faults: list[Fault]) -> Iterator[Scalar]:
    """The scalars of from, to and step, as far as they are there; the rest are faults."""
    for key, _ in node.entries:
        if key.text not in KEYS:
            faults.append(Fault("unknown-key", key.mark, {"key": key.text, "known": ", ".join(KEYS)}))
    for name in KEYS:
        entry = node.find(name)
        if entry is None:
            faults.append(Fault("missing-key", node.mark, {"key": name}))
        elif isinstance(entry[1], Scalar) and not entry[1].null:
            yield entry[1]
        else:
            faults.append(Fault("wrong-type", entry[1].mark, {"expected": "number"}))


def _unit(text: str) -> str:
    match = _TYPED.fullmatch(_plain(text))
    return (match[2] or "").strip() if match else ""


def _plain(text: str) -> str:
    return text.strip().replace("\N{MINUS SIGN}", "-")


def _number(end: Scalar, unit: str, faults: list[Fault]) -> Decimal:
    """The number of an end in `unit`; raises `QuantityFault` once its fault is told."""
    try:
        if not unit:
            read_number(end.text)
            return Decimal(_plain(end.text))
        si = read_quantity(end.text, unit).si
    except QuantityFault as fault:
        faults.append(Fault(fault.code, end.mark, fault.arguments))
        raise
    match = _TYPED.fullmatch(_plain(end.text))
    if match and (match[2] or "").strip() == unit:
        return Decimal(match[1])
    # Another unit of the same kind: 12 digits are more than anyone types and fewer than rounding reaches.
    return Decimal(f"{si / read_unit(unit, unit):.12g}")
