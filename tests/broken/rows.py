"""The rows of the table of wrong files, each as the bytes of a file."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from tests.broken.table import CHANGED, WHOLE

FILES = Path(__file__).parent / "files"
ALL = "…"


@dataclass(frozen=True)
class Row:
    """A wrong file: its bytes, its faults as "LINE:COLUMN CODE", and words that their English messages hold."""

    name: str
    content: bytes
    faults: tuple[str, ...]
    told: tuple[str, ...] = ()


def base(name: str) -> str:
    """A right file that rows start from."""
    return (FILES / f"{name}.yaml").read_text(encoding="utf-8")


def rows() -> Iterator[Row]:
    """The whole table."""
    for file, changed in CHANGED.items():
        for name, changes, faults, *told in changed:
            yield Row(f"{file}: {name}", replaced(base(file), changes).encode(), _each(faults), tuple(told))
    for name, content, faults in WHOLE:
        yield Row(name, content, _each(faults))


def replaced(text: str, changes: Mapping[str, str]) -> str:
    """A text with each change made in its one place; raises `ValueError` where there is none or a second."""
    for old, new in changes.items():
        before, *after = text.split(old.removesuffix(ALL))
        if len(after) != 1:
            raise ValueError(f"{old!r} is there {len(after)} times")
        text = before + new.replace(ALL, old) + ("" if old.endswith(ALL) else after[0])
    return text


def _each(faults: str) -> tuple[str, ...]:
    return tuple(faults.split(", ")) if faults else ()
