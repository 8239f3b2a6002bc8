"""What a template holds: texts, numbers, tuples of these, and tokens for all else.

A token is a number and says whether what it stands for counts as true.  What that is lies in the `Values` of the
report, which alone can be asked for its shown members, for its entries, for what a function gives.  So nothing that a
template can get hold of leads into the program, whatever is done with it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Set
from contextvars import ContextVar
from types import MethodType
from typing import Any

import numpy as np
from jinja2 import Undefined
from jinja2.exceptions import SecurityError

from reportgen.base import shown

PLAIN = frozenset((str, int, float, bool, type(None)))
"""Types of which a template holds the values themselves."""


class Token:
    """Stands for a value of the program: only functions take it, or the page on which it is printed."""

    __slots__ = ("number", "truth")

    def __init__(self, number: int, truth: bool) -> None:
        self.number, self.truth = number, truth

    def __bool__(self) -> bool:
        return self.truth

    def __repr__(self) -> str:
        return type(self).__name__


class FunctionToken(Token):
    """Stands for what a template may call."""

    __slots__ = ()


class Values:
    """What the tokens of a report stand for."""

    def __init__(self) -> None:
        self._held: list[Any] = []
        self._tokens: dict[tuple[int, type[Token]], Token] = {}
        self._names: dict[str, tuple[Any, Any]] = {}
        self.steps = 0
        """Steps of the loops of the section that is being rendered."""

    def names(self, names: Mapping[str, Any]) -> dict[str, Any]:
        """The names of a template with what it holds for them; what can be called is a function."""
        known = self._names
        # Most names of a section have the value that they had in the one before.
        for name, value in names.items():
            if name not in known or known[name][0] is not value:
                plain = self._token(value, FunctionToken) if callable(value) else self.plain(value)
                known[name] = value, plain
        return {name: known[name][1] for name in names}

    def plain(self, value: Any) -> Any:
        """What a template holds for a value: the value itself, a tuple, or a token."""
        kind = type(value)
        if kind in PLAIN:
            return value
        if kind is tuple or kind is list:
            return tuple(map(self.plain, value))
        if shown.members(kind) or isinstance(value, Mapping):
            return self._token(value, Token)
        match value:
            case Token():
                return value
            case str():
                return value[:]
            case int():
                return int(value)
            case float():
                return float(value)
            case MethodType():
                return self._token(value, FunctionToken)
            case np.generic():
                return self.plain(value.item())
            case tuple() | list() | Set() | Iterator() | range():
                return tuple([self.plain(one) for one in value])
        return self._token(value, Token)

    def own(self, value: Any) -> Any:
        """What the program has for what a template holds.  Raises `UndefinedError` for a name that is none."""
        if isinstance(value, Token):
            return self._held[value.number]
        if isinstance(value, tuple):
            return tuple(map(self.own, value))
        return str(value) if isinstance(value, Undefined) else value

    def member(self, of: Token, name: Any) -> Any:
        """A shown member, or an entry, of what a token stands for.  Raises `LookupError`."""
        return self.plain(shown.member(self.own(of), self.own(name)))

    def members(self, of: Token) -> Iterable[Any]:
        """The names of all of them."""
        held = self.own(of)
        return held if isinstance(held, Mapping) else shown.members(type(held)) - {"__str__"}

    def items(self, of: Any) -> tuple[Any, ...]:
        """What a loop goes through: the items of a list, or the keys of a mapping.  Raises `TypeError`."""
        held = self.own(of) if isinstance(of, Token) else of
        if isinstance(held, Mapping):
            return tuple(map(self.plain, held))
        if not isinstance(held, tuple):
            raise TypeError(f"a {type(held).__name__} is no list")
        return held

    def text(self, value: Any) -> str:
        """How a value stands in a text.  Raises `TypeError` for one that has no text."""
        return shown.text(self.own(value))

    def call(self, called: Any, arguments: Iterable[Any], named: Mapping[str, Any]) -> Any:
        """What a function gives.  Raises `SecurityError` for what is none."""
        if not isinstance(called, FunctionToken):
            self.own(called)
            raise SecurityError("not a function")
        function: Callable[..., Any] = self.own(called)
        own = {name: self.own(value) for name, value in named.items()} if named else {}
        return self.plain(function(*map(self.own, arguments), **own))

    def _token(self, value: Any, kind: type[Token]) -> Token:
        # What is held is kept, so that no other value is ever taken for it.
        key = id(value), kind
        found = self._tokens.get(key)
        if found is None:
            found = self._tokens[key] = kind(len(self._held), _counts(value))
            self._held.append(value)
        return found


def _counts(value: Any) -> bool:
    """Whether a value counts as true in a condition."""
    try:
        return bool(value)
    except ValueError:  # an array of several
        return True


held: ContextVar[Values] = ContextVar("held")
"""The values of the report whose templates are being rendered."""
