"""Short words (of captions, of directions) from `words.yaml`, by dotted key."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from types import MappingProxyType

from reportgen.errors import Mark, TemplateError

FILE = "words.yaml"


def load_words(directories: Sequence[Path]) -> Mapping[str, str]:
    """All words of the `words.yaml` in `directories` (see `prose.search_path`), the first of a key wins.

    Nested tables give dotted keys: `figure: {plan: …}` is "figure.plan".  Raises `TemplateError` with file
    and line for what is not a word, and where no directory has the file.
    """
    files = [path for directory in directories if (path := directory / FILE).is_file()]
    if not files:
        raise TemplateError(f"{directories[-1] / FILE}: the file is missing")
    words: dict[str, str] = {}
    for path in reversed(files):
        words.update(_read(path))
    return MappingProxyType(words)


def _read(path: Path) -> dict[str, str]:
    from reportgen.assignment.source import Node, Scalar, Table, read_source

    source = read_source(path)
    if source.faults:
        raise TemplateError("\n".join(f"{fault.mark}: {fault.code}" for fault in source.faults))

    def entries(node: Node | None, prefix: str) -> Iterator[tuple[str, str]]:
        match node:
            case Table(pairs):
                for key, value in pairs:
                    yield from entries(value, f"{prefix}.{key.text}" if prefix else key.text)
            case Scalar(text, null=False) if prefix:
                yield prefix, text
            case _:
                mark = node.mark if node else Mark(source.file)
                raise TemplateError(f"{mark}: {prefix or 'this'} is not a word")

    return dict(entries(source.top, ""))
