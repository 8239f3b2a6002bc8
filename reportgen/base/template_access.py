"""Registry of the attributes that templates may read, by class.

Templates and placeholders can read only these members of a value; a type that is not registered has none. A mapping
shows its entries.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, TypeVar

from reportgen.base.records import field_names

Registered = TypeVar("Registered", bound=type)

MEMBERS: dict[type, frozenset[str]] = {}
"""Readable members of each type; `__str__` among them allows a value to be printed in a text by its name."""

_ALL: dict[type, frozenset[str]] = {}
"""Cache of the members of types together with those of their bases."""


def template_members(*names: str) -> Callable[[Registered], Registered]:
    """Register the members of a class that templates may read."""

    def entered(of: Registered) -> Registered:
        MEMBERS[of] = frozenset(names)
        return of

    return entered


def view(*names: str) -> Callable[[Registered], Registered]:
    """Register the fields of a record or a dataclass that is made for templates, and further members."""

    def entered(of: Registered) -> Registered:
        return template_members(*field_names(of), *names)(of)

    return entered


def members(of: type) -> frozenset[str]:
    """Return the readable members of a type: its own and those of its base classes."""
    if of not in _ALL:
        _ALL[of] = frozenset().union(*(MEMBERS.get(one, ()) for one in of.__mro__))
    return _ALL[of]


def member(of: object, name: str) -> Any:
    """Return a readable member of a value, or the entry of a mapping.  Raises `LookupError` for any other."""
    if isinstance(of, Mapping):
        return of[name]
    if name not in members(type(of)) or name.startswith("_"):
        raise LookupError(name)
    return getattr(of, name)


def text(of: object) -> str:
    """Return a value as text.  Raises `TypeError` if its type has no text."""
    if isinstance(of, bool) or not (isinstance(of, (str, int)) or "__str__" in members(type(of))):
        raise TypeError(f"a {type(of).__name__} has no place in a text")
    return str(of)
