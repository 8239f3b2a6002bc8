"""Turn a value into inlines when it is inserted into a text, such as a phrase with gaps or a proof sheet."""

from __future__ import annotations

from typing import Any, get_args

from reportgen.base.template_access import text as as_text
from reportgen.document import Inline, InlineMath, Inlines, Text, Value
from reportgen.document.markdown import SECRET
from reportgen.document.template_rendering import NamedPoint, inlines_of
from reportgen.formula import Expression, Number, vocabulary


def inlines(of: Any) -> Inlines:
    """Return the inlines for a value in a placeholder: points as symbols, numbers with their unit, else text.

    Formulas and inlines are returned as they are. Raise `TypeError` for a value that cannot be shown in a text.
    """
    if isinstance(of, NamedPoint):
        return (InlineMath(vocabulary.point(of)),)
    if isinstance(of, Number):
        return (Value(of),)
    if isinstance(of, Expression):
        return (InlineMath(of),)
    if isinstance(of, tuple):
        return tuple(part for one in of for part in inlines(one))
    if isinstance(of, get_args(Inline)):
        return (of,)
    return inlines_of(text) if SECRET in (text := as_text(of)) else (Text(text),)
