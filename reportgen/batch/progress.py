"""How far a batch is: a bar on a terminal, otherwise a line for each event that a program can read."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Literal, TextIO

from reportgen.assignment.faults import word
from reportgen.notation.numbers import Language, write

if TYPE_CHECKING:
    from rich.progress import ProgressColumn

Event = Literal["kept", "retried", "done", "failed"]
"""`kept`: made by an earlier run; `retried`: its worker died, another one begins anew."""
Watch = Callable[[str, str, Event], None]
"""Receives the student's folder, the product and what happened: no names, no content."""


@contextmanager
def watching(total: int, stream: TextIO, language: Language) -> Iterator[Watch]:
    """Shows the events of `total` products on a stream: a bar on a terminal, else a line with tabs for each."""
    if stream.isatty():
        with _bar(total, stream, language) as watch:
            yield watch
    else:
        yield lambda *event: print(*event, sep="\t", file=stream, flush=True)


@contextmanager
def _bar(total: int, stream: TextIO, language: Language) -> Iterator[Watch]:
    """A bar with count, rate, time left and the number of failures; what was kept lowers the total."""
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    columns = (
        BarColumn(),
        MofNCompleteColumn(),
        _rate(language),
        TimeRemainingColumn(elapsed_when_finished=True),
        TextColumn("{task.fields[failed]}", style="red"),
    )
    with Progress(*columns, console=Console(file=stream)) as progress:
        task = progress.add_task("", total=total, failed="")
        failed = 0

        def watch(_folder: str, _product: str, event: Event) -> None:
            nonlocal total, failed
            if event == "kept":
                total -= 1
                progress.update(task, total=total)
            elif event != "retried":
                failed += event == "failed"
                text = word("bar_failed", language, count=failed) if failed else ""
                progress.update(task, advance=1, failed=text)

        yield watch


def _rate(language: Language) -> ProgressColumn:
    from rich.progress import ProgressColumn, Task
    from rich.text import Text

    class Rate(ProgressColumn):
        """Products a minute."""

        def render(self, task: Task) -> Text:
            speed = task.finished_speed or task.speed
            rate = "–" if speed is None else write(60 * speed, 0 if speed > 1 else 1, language)
            return Text(word("bar_rate", language, rate=rate), style="progress.data.speed")

    return Rate()
