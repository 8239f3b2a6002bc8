"""Choices of form: keys of the old choice become comments and come back; every fault has a remedy in the form."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from reportgen import catalogue
from reportgen.base.errors import Where
from reportgen.base.yaml_source import MappingNode, Node, Scalar, SequenceNode, plain, read_text
from reportgen.base.yaml_values import at
from reportgen.page.edit_session import EditSession
from reportgen.page.form_choices import with_choice
from tests.kinds import KINDS
from tests.lanes import matrix
from tests.page.form_reader import FormReader

FILES = Path(__file__).parents[2] / "assignments"
FORCE = """\
  force:
    by: constant  # how
    F: 800 N      # how much
    stroke: inward
"""


def session(file: Path, text: str) -> EditSession:
    file.write_bytes(text.encode())
    return EditSession(lambda: pytest.fail("not opened"), "en", path=file)


def crank(force: str = FORCE) -> str:
    text = catalogue.sample("slider-crank", "en")
    return text[: text.index("  force:\n")] + force


def choose(edited: EditSession, where: Where, value: str) -> str:
    answer = edited.edit({"op": "set", "where": list(where), "value": value})
    assert "refused" not in answer
    return str(answer["form"])


BY = ("parameters", "force", "by")


def test_keys_of_the_old_form_are_set_aside_and_come_back(tmp_path: Path) -> None:
    edited = session(tmp_path / "a.yaml", text := crank())
    form = choose(edited, BY, "stroke")
    assert edited.path.read_text(encoding="utf-8") == crank(
        "  force:\n"
        "    by: stroke  # how\n"
        "    # F: 800 N      # how much  # by: constant\n"
        "    # stroke: inward  # by: constant\n"
    )
    assert {("parameters", "force", key) for key in ("unit", "s", "inward", "outward")} <= FormReader(form).fields
    choose(edited, BY, "constant")
    assert edited.path.read_text(encoding="utf-8") == text
    for _ in range(2):
        edited.edit({"op": "undo"})
    assert edited.path.read_text(encoding="utf-8") == text


def test_one_step_back_leads_from_a_form_to_the_other(tmp_path: Path) -> None:
    edited = session(tmp_path / "a.yaml", text := crank())
    choose(edited, BY, "crank_angle")
    edited.edit({"op": "undo"})
    assert edited.path.read_text(encoding="utf-8") == text


def test_each_form_keeps_its_own_value_of_a_key_that_both_have(tmp_path: Path) -> None:
    """F is one force, or a row of forces over the angle; what nobody has chosen stays a comment."""
    edited = session(tmp_path / "a.yaml", crank(FORCE.replace("    stroke", "    # stroke")))
    choose(edited, BY, "crank_angle")
    edited.edit({"op": "set", "where": ["parameters", "force", "F"], "value": "0, 600, 0", "list": True})
    choose(edited, BY, "constant")
    there = edited.path.read_text(encoding="utf-8")
    assert "\n    F: 800 N      # how much\n    # stroke: inward\n" in there
    choose(edited, BY, "crank_angle")
    assert "\n    F: [0, 600, 0]\n" in edited.path.read_text(encoding="utf-8")


@pytest.mark.parametrize("newline", ["\n", "\r\n"])
def test_whole_blocks_with_lists_and_comments_are_set_aside(tmp_path: Path, newline: str) -> None:
    block = (
        "  force:\n    by: stroke\n    unit: N\n    s: [0,  # outer\n      1]\n"
        "    inward:   # in N\n      - 0\n\n      # most\n      - 9\n    outward: [0, 0]\n  s2: 1\n"
    ).replace("\n", newline)
    edited = session(tmp_path / "a.yaml", text := crank("").replace("\n", newline) + block)
    choose(edited, BY, "constant")
    aside = edited.path.read_bytes().decode()
    assert f"    # inward:   # in N  # by: stroke{newline}    #   - 0{newline}{newline}    #   # most{newline}" in aside
    assert plain(read_text(aside).top)["parameters"]["force"] == {"by": "constant"}  # type: ignore[arg-type]
    choose(edited, BY, "stroke")
    assert edited.path.read_bytes().decode() == text


def test_entries_in_braces_are_set_aside_below_them(tmp_path: Path) -> None:
    edited = session(tmp_path / "a.yaml", crank("  force: {by: constant, F: 50 N, stroke: inward}  # how\n"))
    before = edited.path.read_text(encoding="utf-8")
    choose(edited, BY, "crank_angle")
    aside = "  force: {by: crank_angle}  # how\n    # F: 50 N  # by: constant\n    # stroke: inward  # by: constant\n"
    assert edited.path.read_text(encoding="utf-8") == crank(aside)
    choose(edited, BY, "constant")
    assert edited.path.read_text(encoding="utf-8") == before


def test_the_first_entry_after_a_dash_is_set_aside_below_the_next(tmp_path: Path) -> None:
    loads = "  loads:\n  - F: 1 N\n    at: C\n    by: constant\n    link: 2\n  - {by: constant, link: 2, M: 1 N m}\n"
    edited = session(tmp_path / "a.yaml", crank(loads))
    by = ("parameters", "loads", 0, "by")
    choose(edited, by, "angle")
    assert "  - at: C\n    # F: 1 N  # by: constant\n    by: angle\n" in edited.path.read_text(encoding="utf-8")
    edited.edit({"op": "move", "where": ["parameters", "loads"], "first": 0})
    choose(edited, ("parameters", "loads", 1, "by"), "constant")
    content: object = plain(read_text(edited.path.read_text(encoding="utf-8")).top)  # type: ignore[arg-type]
    assert content["parameters"]["loads"] == [  # type: ignore[index]
        {"by": "constant", "link": "2", "M": "1 N m"},
        {"by": "constant", "link": "2", "F": "1 N", "at": "C"},
    ]


TWO_LOADS = "  loads: [{by: constant, link: 2, at: C, F: 100 N}, {by: constant, link: 3, at: C, F: 7 N}]\n"


@pytest.mark.parametrize(
    ("change", "expected"),
    [
        ({"op": "remove", "where": ["parameters", "loads", 0]}, ["7 N"]),
        ({"op": "remove", "where": ["parameters", "loads", 1]}, ["100 N"]),
        ({"op": "move", "where": ["parameters", "loads"], "first": 0}, ["7 N", "100 N"]),
    ],
)
@pytest.mark.parametrize("outer", [False, True])
def test_what_is_set_aside_in_brackets_follows_its_item(
    tmp_path: Path, change: dict[str, object], expected: list[str], outer: bool
) -> None:
    text = f"kind: slider-crank\nparameters: {{{TWO_LOADS.strip()}}}\n" if outer else crank(TWO_LOADS)
    edited = session(tmp_path / "a.yaml", text)
    for index in range(2):
        choose(edited, ("parameters", "loads", index, "by"), "angle")
    edited.edit(change)
    for index in range(len(expected)):
        choose(edited, ("parameters", "loads", index, "by"), "constant")
    changed = edited.path.read_text(encoding="utf-8")
    content: object = plain(read_text(changed).top)  # type: ignore[arg-type]
    assert [load["F"] for load in content["parameters"]["loads"]] == expected  # type: ignore[index]
    assert "# " not in changed[changed.rindex("loads: ") :], "nothing is left aside"


@pytest.mark.parametrize("outer", [False, True])
def test_what_is_set_aside_in_brackets_goes_with_its_key(tmp_path: Path, outer: bool) -> None:
    """Of a list in a line of its own all becomes a comment; a new list in its place has nothing set aside."""
    table = f" {{R: 1 m, {TWO_LOADS.strip()}}}\n" if outer else f"\n  R: 1 m\n{TWO_LOADS}"
    edited = session(tmp_path / "a.yaml", f"kind: slider-crank\nparameters:{table}")
    for index in range(2):
        choose(edited, ("parameters", "loads", index, "by"), "angle")
    edited.edit({"op": "remove", "where": ["parameters", "loads"]})
    edited.edit({"op": "add", "where": ["parameters", "loads"]})
    edited.edit({"op": "set", "where": ["parameters", "loads", 0, "by"], "value": "constant"})
    changed = edited.path.read_text(encoding="utf-8")
    content: object = plain(read_text(changed).top)  # type: ignore[arg-type]
    assert content["parameters"]["loads"] == [{"by": "constant"}]  # type: ignore[index]
    assert "100 N" not in changed


# --- keys with the same meaning -----------------------------------------------------------------------


def instead(edited: EditSession, where: Where, key: str) -> str:
    answer = edited.edit({"op": "instead", "where": list(where), "key": key, "value": ""})
    assert "refused" not in answer
    return edited.path.read_text(encoding="utf-8")


def test_a_key_that_gives_way_comes_back_with_its_value(tmp_path: Path) -> None:
    """The speed as typed, not converted twice; after a change of the other key it is the changed speed."""
    edited = session(tmp_path / "a.yaml", text := catalogue.sample("shaper", "en"))
    assert "\n  # n: 89 rpm  " in instead(edited, ("parameters", "n"), "omega1")
    back = instead(edited, ("parameters", "omega1"), "n")
    assert "\n  n: 89 rpm  " in back
    assert "\n  # omega1: 9.32 rad/s\n" in back
    assert back.replace("  # omega1: 9.32 rad/s\n", "") == text
    instead(edited, ("parameters", "n"), "omega1")
    edited.edit({"op": "set", "where": ["parameters", "omega1"], "value": "12 rad/s"})
    assert "\n  n: 115 rpm  " in instead(edited, ("parameters", "omega1"), "n")


def test_a_weight_comes_back_in_place_of_a_mass(tmp_path: Path) -> None:
    edited = session(tmp_path / "a.yaml", catalogue.sample("shaper", "en").replace("# G3: 200 N", "G3: 200 N"))
    assert "\n  m3:\n" in instead(edited, ("parameters", "G3"), "m3")
    edited.edit({"op": "set", "where": ["parameters", "m3"], "value": "21 kg"})
    assert "\n  G3: 200 N  " in (there := instead(edited, ("parameters", "m3"), "G3"))
    assert "\n  # m3: 21 kg\n" in there
    for _ in range(3):
        edited.edit({"op": "undo"})
    assert "\n  G3: 200 N  " in edited.path.read_text(encoding="utf-8")


def test_a_key_that_excludes_two_sets_both_aside(tmp_path: Path) -> None:
    """The swing of a lever is given in place of two lengths."""
    text = catalogue.sample("lever-six-bar", "en")
    edited = session(tmp_path / "a.yaml", text)
    both = ("AB", "swing") if at(read_text(text).top, ("parameters", "AB")) else ("swing", "AB")
    there = instead(edited, ("parameters", both[0]), both[1])
    there = instead(edited, ("parameters", both[1]), both[0])
    assert plain(read_text(there).top) == plain(read_text(text).top)  # type: ignore[arg-type]


# --- every fault can be mended ------------------------------------------------------------------------


def tables(node: Node | None, where: Where = ()) -> Iterator[tuple[Where, MappingNode]]:
    match node:
        case MappingNode(entries):
            yield where, node
            for key, value in entries:
                yield from tables(value, (*where, key.text))
        case SequenceNode(items):
            for index, item in enumerate(items):
                yield from tables(item, (*where, index))


def texts(kind: str) -> Iterator[str]:
    """The sample of a kind and, of the kinds with most forms, other files."""
    yield catalogue.sample(kind, "en")
    if kind == "linkage":
        yield from ((FILES / f"linkage-{name}.yaml").read_text(encoding="utf-8") for name in ("slide", "8"))


@pytest.mark.parametrize("kind", matrix(KINDS, ["slider-crank", "engine-twin"]))
def test_no_choice_leads_into_a_fault_without_a_remedy(tmp_path: Path, kind: str) -> None:
    """Every choice of every table of the samples; with the first choice again all is as it was."""
    tried = set()
    for text in texts(kind):
        top = read_text(text).top
        choices = FormReader(session(tmp_path / "a.yaml", text).form()).choices
        for where, names in choices.items():
            node = at(top, where)
            if where[0] not in ("parameters", "indicator", "parts") or not isinstance(node, Scalar):
                continue
            for name in names:
                step = (*(key for key in where if isinstance(key, str)), node.text, name)
                if not name or name == node.text or step in tried:
                    continue
                tried.add(step)
                changed = with_choice(text, where, name)
                if changed is not None:
                    back = with_choice(changed, where, node.text)
                    assert back is not None
                    assert plain(read_text(back).top) == plain(top), step  # type: ignore[arg-type]
                else:
                    changed = text[: node.span[0]] + name + text[node.span[1] :]
                assert FormReader(session(tmp_path / "a.yaml", changed).form()).stuck == [], step


def damaged(text: str) -> Iterator[str]:
    """The text with faults: unknown keys in all tables, values of another form, lists of another length."""
    top = read_text(text).top
    every = [table for _, table in tables(top)]
    inserted = text
    for start, in_braces in sorted(
        ((one.span[0], text[one.span[0]] == "{") for one in every if one.entries), reverse=True
    ):
        column = start - text.rfind("\n", 0, start) - 1
        new = "{zzz: 1, yyy: {a: [1]}, " if in_braces else f"zzz: 1\n{' ' * column}yyy: {{a: [1]}}\n{' ' * column}"
        inserted = inserted[:start] + new + inserted[start + in_braces :]
    yield inserted
    values = [value for one in every for key, value in one.entries if key.text != "kind"]
    lists = [value for value in values if isinstance(value, SequenceNode)]
    singles = [value for value in values if isinstance(value, Scalar) and not value.null]
    for chosen, new in ((singles, "{a: 1}"), (singles, "[1, 2]"), (lists, "[1]"), (lists, "5"), (lists, "{a: 1}")):
        changed = text
        for value in sorted(chosen, key=lambda value: value.span, reverse=True):
            if changed[value.span[0]] == "[" or value in singles:
                changed = changed[: value.span[0]] + new + changed[value.span[1] :]
        yield changed
    for value in values:
        if isinstance(value, MappingNode) and text[value.span[0]] == "{":
            yield text[: value.span[0]] + "5" + text[value.span[1] :]


@pytest.mark.parametrize("kind", matrix(KINDS, ["slider-crank"]))
def test_no_fault_of_a_file_is_without_a_remedy(tmp_path: Path, kind: str) -> None:
    faults = 0
    for text in damaged(catalogue.sample(kind, "en")):
        read = FormReader(session(tmp_path / "a.yaml", text).form())
        faults += len(read.faults)
        assert read.stuck == [], text
        if "zzz: 1" in text:
            removable = {where for where in read.mended if where[-1:] == ("zzz",)}
            assert len(removable) == text.count("zzz: 1"), "each unknown key has an ×"
    assert faults > 10
