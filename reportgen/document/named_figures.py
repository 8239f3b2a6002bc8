"""The figures of a finished document by name, each as drawings that can be used on their own, for example as files."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from itertools import chain

from reportgen.base.records import Record, replace
from reportgen.document import Block, Document, Figure, List, Plate, plain
from reportgen.drawing import Scene

_FIGURE = re.compile(r"(^|\.)fig\.")
"""Part of a block's key that marks a figure, after the name of its part: cam.fig.law."""
_UNSAFE = re.compile(r"[^\w.′″-]+")
"""Characters that no file name needs."""


class NamedFigure(Record):
    """A figure of a report: its name, its number and caption as text, its drawings.

    One that shows a position, whose label is `at`, has it at the end of its name, v.4.
    """

    name: str
    number: str
    caption: str
    scenes: tuple[Scene, ...]
    at: str = ""

    @property
    def kind(self) -> str:
        """Its name without its position."""
        return self.name.removesuffix(f".{self.at}") if self.at else self.name

    @property
    def positions(self) -> tuple[str, ...]:
        """The positions that its drawings show one by one."""
        return tuple(dict.fromkeys(scene.at for scene in self.scenes if scene.at))

    def shown_at(self, labels: Sequence[str]) -> NamedFigure | None:
        """Return the figure at a position with one of these labels, the nearest first.

        None if it shows none of them.
        """
        if self.at:
            return self if self.at in labels else None
        for label in labels:
            if scenes := tuple(scene for scene in self.scenes if scene.at == label):
                return replace(self, scenes=scenes)
        return None

    @property
    def files(self) -> Mapping[str, Scene]:
        """Its drawings by the names of their files: of several by their positions, or else counted."""
        if len(self.scenes) == 1 and not self.scenes[0].at:
            return {safe(self.name): self.scenes[0]}
        return {safe(f"{self.name}-{one.at or number}"): one for number, one in enumerate(self.scenes, start=1)}


def named_figures(document: Document) -> tuple[NamedFigure, ...]:
    """Return all figures of a report in their order; a figure on several pages is returned once."""
    figures: list[NamedFigure] = []
    for block in _figures(document.blocks):
        scenes = block.scenes if isinstance(block, Figure) else (block.scene,)
        if isinstance(block, Plate) and block.continues:
            figures[-1] = replace(figures[-1], scenes=figures[-1].scenes + scenes)
        else:
            name = figure_name(block) or str(len(figures) + 1)
            caption = plain(block.caption, document.language)
            figures.append(NamedFigure(name, block.number, caption, scenes, block.at))
    return tuple(figures)


def figure_name(block: Figure | Plate) -> str:
    """Return the name of a figure: its key without the mark of a figure, or its number."""
    return _FIGURE.sub(r"\1", block.key, count=1) or block.number


def safe(name: str) -> str:
    """Return a name in the form of a file name."""
    return _UNSAFE.sub("_", name)


def _figures(blocks: Sequence[Block]) -> Iterator[Figure | Plate]:
    for block in blocks:
        if isinstance(block, (Figure, Plate)):
            yield block
        elif isinstance(block, List):
            yield from _figures(tuple(chain.from_iterable(block.items)))
