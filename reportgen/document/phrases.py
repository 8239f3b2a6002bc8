"""Words that follow from what is counted, from a sign or from a kind: `words.yaml` has them, a template names them.

`{{ driven.balance }}` is what balances the driver that the report has, `{{ counted("each_group", groups) }}` speaks of
one group or of several.  Gaps in braces are filled with members of what the phrase is said of.
"""

from __future__ import annotations

from collections.abc import Sequence, Sized
from string import Formatter
from typing import Any

from reportgen.document.prose import PointName
from reportgen.document.report import Report, function
from reportgen.document.tree import Inline, InlineMath, Inlines, Text, Value
from reportgen.notation import vocabulary
from reportgen.notation.expressions import Expression, Number


@function
def say(report: Report, phrase: str, *about: Any, **gaps: Any) -> Inlines:
    """A phrase of `words.yaml` whose gaps are filled by name, or with members of what it is about."""
    said: list[Inline] = []
    for text, name, _, _ in Formatter().parse(str(phrase)):
        said += [Text(text)] if text else []
        if name:
            owner = next((one for one in about if hasattr(one, name)), None)
            said += inlines(gaps[name] if name in gaps else getattr(owner, name))
    return tuple(said)


def inlines(value: Any) -> Inlines:
    """What fills a gap: points as symbols, numbers with their unit, formulas, inlines, else text."""
    if isinstance(value, PointName):
        return (InlineMath(vocabulary.point(value)),)
    if isinstance(value, Number):
        return (Value(value),)
    if isinstance(value, Expression):
        return (InlineMath(value),)
    if isinstance(value, (str, int)):
        return (Text(str(value)),)
    return value if isinstance(value, tuple) else (value,)


@function
def counted(report: Report, name: str, things: Sized) -> Inlines:
    """A phrase about so many things, by the words for one and for many; nothing for none.

    The words may have gaps for their `count`, and for the `list` of them.
    """
    if not len(things):
        return ()
    one, many = report.words["counted"][name]
    listed = ", ".join(map(str, things)) if isinstance(things, Sequence) else ""
    return say(report, one if len(things) == 1 else many, count=len(things), list=listed)


@function
def stop(report: Report, loop: Any, *further: Sized) -> str:
    """What ends an item of a list: a full stop after the last one, if nothing `further` follows it."""
    return "." if loop.last and not any(map(len, further)) else ";"
