"""How well made-up reports are read: `python -m tests.handin.figures [SEEDS]` prints it by manners."""

from __future__ import annotations

import sys
import time
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from reportgen.handin import FileReading
from reportgen.handin.word_file import open_word
from reportgen.handin.word_reader import read_report
from tests.handin import made_reports, reports


@dataclass(frozen=True)
class Read:
    """What was read of a report: how many values stand there, how many were read, which are not what stands there."""

    stand: int
    read: int
    wrong: Mapping[tuple[str, int], str]


def judged(made: made_reports.Report, reading: FileReading) -> Read:
    """A value is wrong where something else, or nothing, was put; its size counts, a sense is said nowhere."""
    wrong = {
        place: answer.text
        for place, answer in reading.values.items()
        if place not in made.truth or abs(abs(answer.value) - abs(made.truth[place])) > 1e-6 * abs(made.truth[place])
    }
    return Read(len(made.truth), len(reading.values.keys() & made.truth.keys()), wrong)


def read(made: made_reports.Report) -> FileReading:
    path = Path("report.docx")
    return read_report(open_word(path, made.file()).blocks, made.key, str(path))


def main(seeds: int = 8) -> int:
    stand: Counter[str] = Counter()
    done: Counter[str] = Counter()
    wrong = 0
    slowest = 0.0
    for manner, machine, seed in reports.each(range(seeds)):
        made = reports.report(manner, machine, seed)
        start = time.process_time()
        result = judged(made, read(made))
        slowest = max(slowest, time.process_time() - start)
        stand[manner] += result.stand
        done[manner] += result.read
        wrong += len(result.wrong)
        for place, text in result.wrong.items():
            print("wrong", manner, machine, seed, place, text, made.truth.get(place), made.texts.get(place))
    for manner, count in stand.items():
        print(f"{manner:20} {done[manner]:6} of {count:6}  {done[manner] / count:.1%}")
    print(f"wrong: {wrong} of {sum(done.values())}; the slowest took {slowest:.2f} s")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(*map(int, sys.argv[1:])))
