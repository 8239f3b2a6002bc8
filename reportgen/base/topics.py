"""Registry of topics: optional subjects of a machine, such as friction or a flywheel.

A topic is a folder of the package with a module `topic`; the folder has the name of its section's key in the file. A
layer that topics can extend declares a record of typed functions and one `HookModule` for it. A topic that
extends the layer has a module of that name with an object `HOOKS` of that class. So a layer names no topic, no topic
names another, and a machine imports only the topics that its file uses.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Generic, TypeVar

PACKAGE = Path(__file__).parents[1]
TOPIC_MODULE = "topic"
"""The module that makes a folder of the package a topic."""

Hooks = TypeVar("Hooks")


@cache
def topics() -> tuple[str, ...]:
    """Return the names of all topics, in alphabetical order."""
    return tuple(sorted(file.parent.name for file in PACKAGE.glob(f"*/{TOPIC_MODULE}.py")))


class HookModule(Generic[Hooks]):
    """The modules of one name in all topics, each with an object `HOOKS` of one class."""

    def __init__(self, name: str, hooks: type[Hooks]) -> None:
        self.name = name
        self.hooks = hooks
        self._loaded: dict[str, Hooks | None] = {}

    def of(self, topic: str) -> Hooks | None:
        """Return the hooks of a topic, None if it has no such module."""
        if topic not in self._loaded:
            self._loaded[topic] = self._load(topic)
        return self._loaded[topic]

    def _load(self, topic: str) -> Hooks | None:
        if not (PACKAGE / topic / f"{self.name}.py").is_file():
            return None
        hooks = import_module(f"{PACKAGE.name}.{topic}.{self.name}").HOOKS
        assert isinstance(hooks, self.hooks), f"{topic}.{self.name}.HOOKS is not a {self.hooks.__name__}"
        return hooks

    def among(self, names: Iterable[str]) -> Iterator[Hooks]:
        """Yield the hooks of some topics, in the order of the names, skipping topics without such a module."""
        for name in names:
            if (hooks := self.of(name)) is not None:
                yield hooks
