"""Other items in a list of a YAML text: those that stay keep their text, their comments and the space around them."""

from __future__ import annotations

import random
import re

import pytest

from reportgen.base.yaml_edit import as_list
from reportgen.base.yaml_lists import with_items
from reportgen.base.yaml_source import plain, read_text
from tests.base.test_other_bytes import is_within

BEFORE, AFTER = "a: 1  # one\nt:\n  row:", "\n  # below: 2\n  z: [1,2]   # z\n"


def a_list(chance: random.Random, values: list[str], in_lines: bool) -> str:
    """A list of values in block form, or in brackets in one or several lines; some have comments, and space."""
    comments = [f"  # of {value}" if chance.random() < 0.5 else "" for value in values]
    space = " " * chance.randint(0, 3)
    if in_lines:
        lines = [f"  - {space}{value}{comment}" for value, comment in zip(values, comments, strict=True)]
        deeper = [f"{line}\n    # deeper" if chance.random() < 0.2 else line for line in lines]
        return "\n" + "\n".join(f"\n{line}" if chance.random() < 0.1 else line for line in deeper)
    if chance.random() < 0.5:
        return f" [{space}{f' ,{space}'.join(values)}{space}]"
    pairs = list(zip(values, comments, strict=True))
    lines = [f"{value},{space}{comment}" for value, comment in pairs[:-1]]
    last = f"{pairs[-1][0]}{chance.choice(['', ','])}{pairs[-1][1]}"
    return " [ " + "\n     ".join([*lines, last]) + "\n    ]  # row"


@pytest.mark.parametrize("in_lines", [False, True])
def test_items_that_stay_keep_their_text_and_comments(in_lines: bool) -> None:
    for seed in range(150):
        change_at_random(seed, in_lines)


def change_at_random(seed: int, in_lines: bool) -> None:
    """Remove some items, and add some or none; the values are all different."""
    chance = random.Random(seed)
    values = [f"v{number} mm" if number % 3 else f"[{number},  {number} mm]" for number in range(chance.randint(1, 7))]
    listed = a_list(chance, values, in_lines)
    text = BEFORE + listed + AFTER
    kept = [value for value in values if chance.random() < 0.7]
    wanted = list(kept)
    for number in range(chance.randint(0 if kept else 1, 2)):
        wanted.insert(chance.randint(0, len(wanted)), f"new {number}")
    if chance.random() < 0.2:
        text = text.replace("\n", "\r\n")
    new = as_list(", ".join(wanted))
    after = with_items(text, ("t", "row"), new)
    assert plain(read_text(after).top)["t"]["row"] == plain(new), seed  # type: ignore[arg-type]
    begin, end = len(text.split("row:")[0]), len(text.partition("z: ")[2])
    assert after[:begin] == text[:begin], seed
    assert after[-end:] == text[-end:], seed
    assert after.count("\r") == ("\r" in text) * after.count("\n"), seed
    if len(wanted) == len(values):
        return
    lines = after.splitlines()
    for value in kept:
        line = next(line for line in lines if re.search(rf"(?<!\d){re.escape(value)}", line))
        if f"# of {value}" in text:
            assert f"# of {value}" in line, (seed, value)
    if (len(kept), len(wanted)) in ((len(values), len(values) + 1), (len(values) - 1, len(values) - 1)):
        short, long = sorted((squeezed(text), squeezed(after)), key=len)
        assert is_within(short, long), seed


def squeezed(text: str) -> str:
    return re.sub(r"[\s,]", "", text)


def test_one_item_more_or_less_changes_nothing_else() -> None:
    text = "row: [1,  2 ,  # two\n      3]  # row\nlist:\n- 1   # one\n# above\n-  2\nend: [1,2,  6]\n"

    def row(place: str, items: str) -> str:
        return with_items(text, (place,), as_list(items))

    assert row("row", "1, 2, 3, 4") == text.replace("3]", "3, 4]")
    assert row("row", "2, 3") == text.replace("1,  2", "2")
    assert row("end", "1, 2") == text.replace("2,  6]", "2]")
    assert row("end", "1, 5, 2, 6") == text.replace("[1,2", "[1,5, 2")
    assert row("list", "1, 2, 3") == text.replace("-  2\n", "-  2\n- 3\n")
    assert row("list", "2") == text.replace("- 1   # one\n", "")
    assert row("list", "1, 7, 2") == text.replace("# one\n", "# one\n- 7\n")


def test_long_tables_are_changed_at_once() -> None:
    """Two thousand rows, of which each other one is new."""
    rows = [f"[{number}, 0]" for number in range(2000)]
    text = "a:\n" + "".join(f"  - {row}  # {index}\n" for index, row in enumerate(rows))
    after = with_items(text, ("a",), as_list(", ".join(f"{row}, [0, 0]" for row in rows)))
    assert after.count("\n") == 4001
