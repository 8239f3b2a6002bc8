"""The marks of a class as rows of a table, for the instructor alone."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence

from reportgen.answers.key import Key
from reportgen.answers.sheet import symbol_text
from reportgen.grading.marks import Marked, Marking
from reportgen.notation.numbers import Language
from reportgen.notation.vocabulary import Chapter
from reportgen.words import load_words, search_path

Value = str | float | None


def grade_rows(
    markings: Sequence[Marking], language: Language, missing: Sequence[Key] = ()
) -> tuple[tuple[Value, ...], ...]:
    """Head and rows of `grades.csv`: who, points, points by part, the first error and its name, warnings, flags.

    `missing` are keys of those who handed nothing in; their points stay empty.
    """
    words = load_words(search_path(language))
    names, parts = words["grades"], parts_of(markings)
    head = (
        *(names[name] for name in ("id", "name", "class", "points", "out_of")),
        *(str(words["parts"][part]) for part in parts),
        *(names[name] for name in ("first", "mistake", "warnings", "flags")),
    )
    rows: list[tuple[Value, ...]] = [head]
    for marking in markings:
        first = next(iter(marking.firsts), None)
        rows.append(
            (
                *who(marking.key),
                _rounded(marking.points),
                _rounded(marking.out_of),
                *(_of_part(marking, part) for part in parts),
                cell_text(marking.key, first) if first else "",
                words["mistake_names"][first.mistake or "none"] if first else "",
                ", ".join(words["warning_names"][warning] for warning in marking.warnings),
                flags(marking),
            )
        )
    rows += [(*who(key), None, None, *(None for _ in parts), "", "", "", "") for key in missing]
    return tuple(rows)


def parts_of(markings: Iterable[Marking]) -> tuple[Chapter, ...]:
    """The parts in which anything was judged, in their order."""
    found = {marking.key.row(cell.id).part for marking in markings for cell in marking.cells}
    return tuple(part for part in Chapter if part in found)


def cell_text(key: Key, cell: Marked) -> str:
    """A quantity and its position in one line: v_BA (3)."""
    symbol = symbol_text(key.row(cell.id), key)
    return f"{symbol} ({key.labels[cell.position - 1]})" if cell.position else symbol


def student_id(key: Key) -> str:
    """The student's id, or else the assignment's."""
    return key.student.get("id", key.id)


def flags(marking: Marking) -> str:
    """The assignments whose keys some values equal, with their number, the most frequent first."""
    counts = Counter(name for cell in marking.cells for name in cell.classmates)
    found = sorted(counts.items(), key=lambda item: (-item[1], item[0]))
    return ", ".join(f"{name} ({count})" for name, count in found)


def who(key: Key) -> tuple[str, str, str]:
    """Id, name and class of a student, as far as they are known."""
    return (student_id(key), key.student.get("name", ""), key.student.get("class", ""))


def _of_part(marking: Marking, part: Chapter) -> float:
    return _rounded(sum(cell.points for cell in marking.cells if marking.key.row(cell.id).part is part))


def _rounded(points: float) -> float:
    return round(points, 2)
