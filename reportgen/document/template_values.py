"""The values that a template can use: texts, numbers, tuples of these, and tokens for everything else.

A token is a number that also says whether the object behind it counts as true. The object itself stays in the `Values`
of the report, which give out only its registered members, its entries and the results of functions. So a template never
has a reference into the program.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence, Set
from contextvars import ContextVar
from functools import cache, partial
from inspect import CO_VARARGS
from itertools import chain, repeat
from types import FunctionType, MethodType
from typing import Any

import numpy as np
from jinja2 import Undefined
from jinja2.exceptions import SecurityError

from reportgen.base import template_access
from reportgen.document.markdown import SECRET

PLAIN = frozenset((str, int, float, bool, type(None)))
"""Types whose values a template gets themselves."""


class Token:
    """A number that represents a value of the program; only functions and the printed page accept it."""

    __slots__ = ("number", "truth")

    def __init__(self, number: int, truth: bool) -> None:
        self.number, self.truth = number, truth

    def __bool__(self) -> bool:
        return self.truth

    def __repr__(self) -> str:
        return type(self).__name__


class FunctionToken(Token):
    """Token of a function that a template may call."""

    __slots__ = ()


class Values:
    """Values behind the tokens of a report."""

    def __init__(self) -> None:
        self._held: list[Any] = []
        self._tokens: dict[tuple[int, type[Token]], Token] = {}
        self._names: dict[str, tuple[Any, Any]] = {}
        self.steps = 0
        """Steps of the loops of the section that is being rendered."""

    def names(self, names: Mapping[str, Any]) -> dict[str, Any]:
        """Return the names of a template with their template values; a callable becomes a function token."""
        known = self._names
        # Most names of a section have the value that they had in the one before.
        for name, value in names.items():
            if name not in known or known[name][0] is not value:
                plain = self._token(value, FunctionToken) if callable(value) else self.plain(value)
                known[name] = value, plain
        return {name: known[name][1] for name in names}

    def plain(self, value: Any) -> Any:
        """Return the template's form of a value: the value itself, a tuple, or a token."""
        kind = type(value)
        if kind in PLAIN:
            return value
        if kind is tuple or kind is list:
            return tuple(map(self.plain, value))
        if template_access.members(kind) or isinstance(value, Mapping):
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
        """Return the program's value behind a template's value; raise `UndefinedError` for an undefined name."""
        if isinstance(value, Token):
            return self._held[value.number]
        if isinstance(value, tuple):
            return tuple(map(self.own, value))
        return str(value) if isinstance(value, Undefined) else value

    def member(self, of: Token, name: Any) -> Any:
        """Return a registered member, or an entry, of a token's value; raise `LookupError`."""
        return self.plain(template_access.member(self.own(of), self.own(name)))

    def members(self, of: Token) -> Iterable[Any]:
        """Return the names of all members of a token's value."""
        held = self.own(of)
        return held if isinstance(held, Mapping) else template_access.members(type(held)) - {"__str__"}

    def items(self, of: Any) -> tuple[Any, ...]:
        """Return the items of a loop: those of a list, or the keys of a mapping.

        Raise `TypeError` for anything else.
        """
        held = self.own(of) if isinstance(of, Token) else of
        if isinstance(held, Mapping):
            return tuple(map(self.plain, held))
        if not isinstance(held, tuple):
            raise TypeError(f"a {type(held).__name__} is no list")
        return held

    def text(self, value: Any) -> str:
        """Return a value as text; raise `TypeError` for a value that has no text."""
        return template_access.text(self.own(value))

    def call(self, called: Any, arguments: Iterable[Any], named: Mapping[str, Any]) -> Any:
        """Call a function; raise `SecurityError` if it is not a function, `TypeError` for wrong arguments."""
        if not isinstance(called, FunctionToken):
            self.own(called)
            raise SecurityError("not a function")
        function: Callable[..., Any] = self.own(called)
        own = [self.own(value) for value in arguments]
        own_named = {name: self.own(value) for name, value in named.items()} if named else {}
        _judge(function, own, own_named)
        return self.plain(function(*own, **own_named))

    def _token(self, value: Any, kind: type[Token]) -> Token:
        # What is held is kept, so that no other value is ever taken for it.
        key = id(value), kind
        token = self._tokens.get(key)
        if token is None:
            token = self._tokens[key] = kind(len(self._held), _counts(value))
            self._held.append(value)
        return token


def _counts(value: Any) -> bool:
    """Return True if a value counts as true in a condition."""
    try:
        return bool(value)
    except ValueError:  # an array of several
        return True


# --- what functions take ------------------------------------------------------------------------------
# Where a function wants a text or a number it makes a name of it: of anything else, its inside would show.

Marked = str
"""A text that may have pieces of the template in it, of a function that reads them."""

_PLAIN = r"(?:str|int|float|bool|None)"
_ONE = re.compile(rf"{_PLAIN}(?: \| {_PLAIN})*")
_SEVERAL = re.compile(rf"\w+\[{_PLAIN}(?:, \.\.\.)?\](?: \| None)?")


def _is_text_or_number(value: Any) -> bool:
    return SECRET not in value if isinstance(value, str) else value is None or isinstance(value, (int, float))


def _are_texts_or_numbers(value: Any) -> bool:
    return _is_text_or_number(value) or all(map(_is_text_or_number, value))


@cache
def _wanted(function: FunctionType, given: int) -> tuple[Sequence[str], str, Mapping[str, Callable[[Any], bool]]]:
    """Return the parameters of a function after the `given` ones.

    The result is their names, the name of all further ones, and a check for each of them.
    """
    judges: dict[str, Callable[[Any], bool]] = {}
    for name, wanted in function.__annotations__.items():
        if _ONE.fullmatch(str(wanted)):
            judges[name] = _is_text_or_number
        elif _SEVERAL.fullmatch(str(wanted)):
            judges[name] = _are_texts_or_numbers
    names, count = function.__code__.co_varnames, function.__code__.co_argcount
    further = count + function.__code__.co_kwonlyargcount
    return names[given:count], names[further] if function.__code__.co_flags & CO_VARARGS else "", judges


def _judge(function: Any, arguments: Sequence[Any], named: Mapping[str, Any]) -> None:
    """Raise `TypeError` if a function that requires texts or numbers gets anything else."""
    given = 0
    while not isinstance(function, FunctionType):
        if isinstance(function, partial):
            given, function = given + len(function.args), function.func
        elif isinstance(function, MethodType):
            given, function = given + 1, function.__func__
        else:
            return
    names, further, judges = _wanted(function, given)
    pairs = zip(chain(names, repeat(further)), arguments, strict=False)
    for name, value in (*pairs, *named.items()):
        if name in judges and not judges[name](value):
            raise TypeError(f"{name} is a text or a number, not a {type(value).__name__}")


held: ContextVar[Values] = ContextVar("held")
"""The values of the report whose templates are being rendered."""
