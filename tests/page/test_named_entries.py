"""Tables whose keys are names of the user, in the form: entries are added, renamed and removed."""

from __future__ import annotations

from pathlib import Path

import pytest

from reportgen import api, catalogue
from reportgen.base.yaml_edit import EditError
from reportgen.base.yaml_names import renamed
from reportgen.page.edit_session import EditSession
from tests.page.browser import Browser
from tests.page.form_reader import FormReader
from tests.page.typist import form_alone, until

BLOCK = "kind: linkage\nparameters:\n  frame:   # fixed\n    A: [0 mm, 0 mm]  # crank\n    D: [300 mm, 0 mm]\n"
AT = ("parameters", "frame", "D")


@pytest.mark.parametrize("newline", ["\n", "\r\n"])
def test_only_the_name_changes(newline: str) -> None:
    text = BLOCK.replace("\n", newline)
    assert renamed(text, AT, "K2") == text.replace("    D:", "    K2:")
    assert renamed(text, AT, "D") == text


def test_names_in_braces_and_names_that_need_marks() -> None:
    text = "parameters: {frame: {A: [0 mm, 0 mm], D: [1 m, 0 m]}}  # all\n"
    assert renamed(text, AT, "E") == text.replace("D:", "E:")
    assert renamed(text, AT, "no") == text.replace("D:", '"no":')


@pytest.mark.parametrize(
    ("where", "name", "reason"), [(AT, "A", "name_taken"), (AT, "", "name_empty"), ((*AT[:-1], "Z"), "B", "nothing")]
)
def test_what_cannot_be_renamed(where: tuple[str, ...], name: str, reason: str) -> None:
    with pytest.raises(EditError) as refused:
        renamed(BLOCK, where, name)
    assert refused.value.key == reason


GROUP = ("parameters", "groups", 0)
LEGS = [("2", "B, D", "130 mm"), ("4", "K, E", "190 mm"), ("5", "C, F", "150 mm")]


def test_a_group_of_class_iii_is_made_in_the_form(tmp_path: Path) -> None:
    """Each value is typed into a field that the form has at that moment; the file is then in order."""
    file = tmp_path / "mine.yaml"
    text = catalogue.sample("linkage", "en")
    begin, end = text.index("  groups:"), text.index("  declared:")
    file.write_text(text[:begin] + "  groups:\n    - {type: RRR}\n" + text[end:], encoding="utf-8")
    edited = EditSession(lambda: pytest.fail("not opened"), "en", path=file)

    def change(operation: str, where: tuple[str | int, ...], **more: object) -> None:
        answer = edited.edit({"op": operation, "where": list(where), **more})
        assert "refused" not in answer, answer

    def put(where: tuple[str | int, ...], value: str, *, row: bool = False) -> None:
        assert where in FormReader(edited.form()).fields, where
        change("set", where, value=value, list=row)

    put((*GROUP, "type"), "3RRR")
    put((*GROUP, "plate"), "3")
    for index, (link, joints, length) in enumerate(LEGS):
        change("add", (*GROUP, "legs"))
        put((*GROUP, "legs", index, "link"), link)
        put((*GROUP, "legs", index, "joints"), joints, row=True)
        put((*GROUP, "legs", index, "length"), length)
    for key, name, value in (("at", "E", "100 mm, 0 mm"), ("at", "G", "60 mm, 140 mm"), ("near", "D", "83 mm, 160 mm")):
        assert (*GROUP, key) in FormReader(edited.form()).mended
        change("add", (*GROUP, key), name=name, table=False)
        put((*GROUP, key, name), value, row=True)
    # The third joint is F; the fixed points of the sample are A and D.
    change("rename", (*GROUP, "at", "G"), name="F")
    put((*GROUP, "near_at"), "60 deg")
    change("rename", ("parameters", "frame", "D"), name="K")
    put(("parameters", "frame", "K"), "300 mm, -30 mm", row=True)
    change("add", ("parameters", "frame"), name="C", table=False)
    put(("parameters", "frame", "C"), "70 mm, 300 mm", row=True)
    put(("parameters", "driver", "length"), "50 mm")
    change("remove", ("parameters", "declared"))
    assert FormReader(edited.form()).faults == []
    (triad,) = api.load(file, "en").parameters.linkage.triads
    assert [leg.inner for leg in triad.legs] == ["D", "E", "F"]
    assert triad.at == (0.1, 0.06 + 0.14j)


RENAME = """
const field = document.getElementById(arguments[0]).closest(".field"), details = field.querySelector(".rename");
details.open = true;
details.querySelector("input").value = arguments[1];
details.querySelector("[data-rename]").click();
"""
ADD = """
const group = [...document.querySelectorAll("fieldset")].filter((one) => one.dataset.w === arguments[0]).pop();
group.querySelector("[data-loose][id]").value = arguments[1];
group.querySelector("[data-name]").click();
"""
FOCUSED = "return document.activeElement.id"


def test_a_name_is_changed_and_added_with_the_mouse(browser: Browser, tmp_path: Path) -> None:
    """The new field has the focus, and the file the new name with its old value."""
    file = tmp_path / "mine.yaml"
    file.write_text(catalogue.sample("linkage", "en"), encoding="utf-8")
    with form_alone(file) as server:
        browser.show(server.address, still=True)
        browser.run(RENAME, "f:parameters.frame.D", "K")
        until(lambda: browser.run(FOCUSED) == "f:parameters.frame.K", lambda: browser.run(FOCUSED))
        assert "    K: [300 mm, 0 mm]\n" in file.read_text(encoding="utf-8")
        browser.run(ADD, '["parameters", "frame"]', "C")
        until(lambda: browser.run(FOCUSED) == "f:parameters.frame.C", lambda: browser.run(FOCUSED))
        assert "    C:\n" in file.read_text(encoding="utf-8")
