"""The form of a file: a field for every key, changes that leave the rest of the file, faults beside their fields."""

from __future__ import annotations

import errno
import http.client
import inspect
import json
import os
import re
import threading
from collections.abc import Iterator
from contextlib import closing, contextmanager
from functools import partial
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import pytest

from reportgen import catalogue
from reportgen.assignment.schema import alternatives, file_schema
from reportgen.base import yaml_edit, yaml_names, yaml_source
from reportgen.base.errors import Where
from reportgen.base.kinds import kinds
from reportgen.base.template_folders import search_path
from reportgen.base.units import Language
from reportgen.base.words import load_words
from reportgen.base.yaml_source import LARGEST, MappingNode, read_text
from reportgen.cases import open_case
from reportgen.page import edit_session, form_choices, html
from reportgen.page.edit_session import EditSession, RefusedChangeError
from reportgen.page.form_fields import FieldGroup, FieldLine, Form
from reportgen.page.kind_chooser import Chooser
from reportgen.page.local_server import Server
from tests.kinds import KINDS
from tests.lanes import matrix

SHAPER = catalogue.sample("shaper", "en")


def session(folder: Path, text: str | bytes = SHAPER, name: str = "shaper.yaml") -> EditSession:
    file = folder / name
    file.write_bytes(text.encode() if isinstance(text, str) else text)
    return EditSession(partial(open_case, file), "en", path=file)


def entries(groups: Any) -> Iterator[FieldLine]:
    for group in groups:
        yield from entries(group.entries) if isinstance(group, FieldGroup) else (group,)


def put(edited: EditSession, where: Where, value: str, **more: Any) -> dict[str, Any]:
    return dict(edited.edit({"op": "set", "where": list(where), "value": value, **more}))


IN_BOTH = [(kind, language) for kind in KINDS for language in ("vi", "en")]


@pytest.mark.parametrize(("kind", "language"), matrix(IN_BOTH, IN_BOTH[::4] + IN_BOTH[3::4]))
def test_every_key_has_its_field(kind: str, language: Language) -> None:
    """All keys of the sections, and all parameters, in one form, each with words that are not its key alone."""
    known = catalogue.kind(kind)
    top = read_text(catalogue.sample(kind, language)).top
    assert isinstance(top, MappingNode)
    groups = Form(known, language, top).groups
    asked = {entry.where for entry in entries(groups)} | set(_tables(groups))
    root = file_schema(known)
    (parameters,) = alternatives(root["properties"]["parameters"], root)
    alike = {key for entry in entries(groups) for key, _ in entry.instead}
    shown = {where[1] for where in asked if where[:1] == ("parameters",) and len(where) > 1}
    assert parameters["properties"].keys() <= shown | alike
    assert root["properties"].keys() - {"kind"} <= {where[0] for where in asked if where}
    texts = {where: text for where, text in _written(top) if where[0] != "kind"}
    for entry in entries(groups):
        if entry.where in texts:
            assert entry.text == texts[entry.where]


def _tables(groups: Any) -> Iterator[Where]:
    for group in groups:
        if isinstance(group, FieldGroup):
            yield group.where
            yield from _tables(group.entries)


def _written(node: Any, where: Where = ()) -> Iterator[tuple[Where, str]]:
    for key, value in node.entries:
        if isinstance(value, MappingNode):
            yield from _written(value, (*where, key.text))
        elif hasattr(value, "text"):
            yield (*where, key.text), "" if value.null else value.text


def test_the_form_is_small(tmp_path: Path) -> None:
    """The longest form has 60 kB, what only a form needs of scripts and styles 77 kB."""
    edited = session(tmp_path, catalogue.sample("linkage", "vi"))
    assert len(edited.form().encode()) < 60_000
    scripts = [html.minified(name) for name in (*edit_session.SCRIPTS, html.FEED) if name != "live.js"]
    styles = [html.read(name) for name in edit_session.STYLES if name != "live.css"]
    assert sum(len(text.encode()) for text in (*scripts, *styles)) < 77_000


def test_a_quantity_knows_unit_bounds_and_what_may_stand_instead() -> None:
    top = read_text(SHAPER).top
    assert isinstance(top, MappingNode)
    fields = {entry.where: entry for entry in entries(Form(catalogue.kind("shaper"), "en", top).groups)}
    l3, speed = fields["parameters", "l3"], fields["parameters", "n"]
    assert (l3.look, l3.unit, l3.low, l3.high, l3.text) == ("quantity", "mm", 0.1, 1e5, "550 mm")
    assert (speed.instead[0][0], speed.required) == ("omega1", True)
    assert ("parameters", "omega1") not in fields
    assert fields["parameters", "g"].default == "9.81 m/s2"
    assert fields["positions", "direction"].choices[1][0] == "clockwise"


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
@pytest.mark.parametrize("newline", ["\n", "\r\n"])
def test_a_change_leaves_the_rest_of_the_file(tmp_path: Path, encoding: str, newline: str) -> None:
    before = SHAPER.replace("\n", newline).encode(encoding)
    edited = session(tmp_path, before)
    link = tmp_path / "link.yaml"
    link.symlink_to(edited.path)
    edited.path.chmod(0o640)
    edited.path = link
    assert "refused" not in put(edited, ("parameters", "a"), "275 mm", was="270 mm")
    assert link.read_bytes() == SHAPER.replace("a: 270", "a: 275").replace("\n", newline).encode(encoding)
    assert link.is_symlink()
    assert link.stat().st_mode & 0o777 == 0o640
    edited.edit({"op": "undo"})
    assert link.read_bytes() == before
    edited.edit({"op": "redo"})
    assert b"275" in link.read_bytes().replace(b"\0", b"")


def test_what_is_typed_is_saved_and_its_fault_stands_beside_it(tmp_path: Path) -> None:
    edited = session(tmp_path)
    form = put(edited, ("parameters", "a"), "95", was="270 mm")["form"]
    assert "  a: 95   " in edited.path.read_text(encoding="utf-8")
    field = form[form.index('id="f:parameters.a"') :]
    assert 'aria-invalid="true"' in field[: field.index(">")]
    assert 'data-remedy="95 mm"' in field[: field.index("parameters.b")]
    assert 'data-goto="[&#34;parameters&#34;, &#34;a&#34;]"' in form
    assert (
        'aria-invalid="true"'
        not in put(edited, ("parameters", "a"), "95 mm", was="95")["form"].partition("f:parameters.b")[0]
    )


@pytest.mark.parametrize("value", ["a # b", "a: b", "two\nlines", "0,35", "[1", "'", '"', "{{ 7*7 }}", "<script>"])
def test_nothing_typed_becomes_anything_else(tmp_path: Path, value: str) -> None:
    edited = session(tmp_path)
    form = put(edited, ("report", "faculty"), value)["form"]
    top = read_text(edited.path.read_text(encoding="utf-8")).top
    assert isinstance(top, MappingNode)
    assert dict(_written(top))["report", "faculty"] == value
    assert "<script>" not in form


def test_one_key_gives_way_to_another(tmp_path: Path) -> None:
    """ω₁ in place of n is the same speed; a mass in place of a weight has to be typed."""
    edited = session(tmp_path, SHAPER.replace("# G3: 200 N", "G3: 200 N"))
    edited.edit({"op": "instead", "where": ["parameters", "n"], "key": "omega1", "value": ""})
    assert "\n  omega1: 9.32 rad/s\n" in edited.path.read_text(encoding="utf-8")
    assert catalogue.check(edited.path) == []
    edited.edit({"op": "instead", "where": ["parameters", "G3"], "key": "m3", "value": ""})
    assert "\n  m3:\n" in edited.path.read_text(encoding="utf-8")
    there = edited.edit({"op": "instead", "where": ["parameters", "a"], "key": "b", "value": "1 mm"})
    assert there["refused"].startswith("parameters.a cannot be replaced by b")


def test_parts_are_added_moved_and_removed(tmp_path: Path) -> None:
    """Two cams and gears in place, with the data of a file to begin with; undone, the file is as it was."""
    edited = session(tmp_path)
    for kind in ("cam", "gear-pair"):
        edited.edit({"op": "add", "where": ["parts"], "kind": kind})
    assert [problem for problem in catalogue.check(edited.path) if problem.level == "error"] == []
    form = put(edited, ("parts", 0, "parameters", "h"), "41 mm", was="40 mm")["form"]
    assert 'id="f:parts.1.parameters.z1"' in form
    edited.edit({"op": "move", "where": ["parts"], "first": 0})
    edited.edit({"op": "remove", "where": ["parts", 0]})
    assert [part.alone.kind for part in catalogue.load(edited.path).parts] == ["cam"]
    with pytest.raises(ValueError, match="shaper"):
        edited.edit({"op": "add", "where": ["parts"], "kind": "shaper"})
    for _ in range(5):
        edited.edit({"op": "undo"})
    assert edited.path.read_text(encoding="utf-8") == SHAPER


def test_an_editor_meanwhile_is_not_written_over(tmp_path: Path) -> None:
    edited = session(tmp_path)
    edited.path.write_text(SHAPER.replace("a: 270 mm", "a: 260 mm").replace("b: 520", "b: 521"), encoding="utf-8")
    answer = put(edited, ("parameters", "a"), "275 mm", was="270 mm")
    assert answer["meanwhile"] == "260 mm"
    assert "260 mm" in edited.path.read_text(encoding="utf-8")
    # Another value goes to the newest text.
    assert "refused" not in put(edited, ("parameters", "H"), "419 mm", was="420 mm")
    assert "b: 521" in edited.path.read_text(encoding="utf-8")
    edited.path.write_text(SHAPER, encoding="utf-8")
    assert "refused" in edited.edit({"op": "undo"})
    assert edited.path.read_text(encoding="utf-8") == SHAPER


@pytest.mark.parametrize("text", ["", "a: [1", "- 1\n", "kind: shaper\nparameters: &a {a: 1}\nreport: *a\n"])
def test_a_text_that_no_form_can_hold_is_told_and_left(tmp_path: Path, text: str) -> None:
    edited = session(tmp_path, text)
    assert 'id="problems"' in edited.form()
    put(edited, ("parameters", "a", "b", 3), "1 mm")
    assert edited.path.read_text(encoding="utf-8") == text


def test_files_that_cannot_be_written(tmp_path: Path) -> None:
    edited = session(tmp_path)
    edited.path.chmod(0o444)
    assert "refused" in put(edited, ("parameters", "a"), "275 mm")
    assert edited.path.read_text(encoding="utf-8") == SHAPER
    edited.path.chmod(0o644)
    assert "refused" in put(edited, ("report", "faculty"), "x" * LARGEST)
    assert edited.path.read_text(encoding="utf-8") == SHAPER
    edited.path.unlink()
    assert "refused" in put(edited, ("parameters", "a"), "275 mm")
    assert list(tmp_path.iterdir()) == []


def test_a_full_disk_is_told_and_leaves_the_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Some of the new text has room: the file is the old one, nothing lies beside it, nothing is there to undo."""
    edited = session(tmp_path)

    def full(path: Path, content: bytes) -> int:
        with path.open("wb") as file:
            file.write(content[:100])
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    with monkeypatch.context() as disk:
        disk.setattr(Path, "write_bytes", full)
        refused = put(edited, ("parameters", "a"), "275 mm")["refused"]
    assert refused == "The file cannot be written: the disk is full."
    assert (list(tmp_path.iterdir()), edited.done) == ([edited.path], [])
    assert edited.path.read_text(encoding="utf-8") == SHAPER
    assert "refused" not in put(edited, ("parameters", "a"), "275 mm"), "there is room again"


@pytest.mark.parametrize("language", ["vi", "en"])
def test_what_is_refused_is_told_in_the_language_of_the_form(language: Language) -> None:
    """Every reason that the code names has its words, and no words are left over."""
    words = load_words(search_path(language))["edit"]
    named = re.compile(r'(?:EditError|RefusedChangeError)\("(\w+)"')
    modules = yaml_edit, yaml_names, edit_session, form_choices
    keys = {key for module in modules for key in named.findall(inspect.getsource(module))}
    assert keys == words["refused"].keys()
    assert {"ENOSPC", "EACCES", "EROFS"} <= words["reasons"].keys() <= set(errno.errorcode.values())
    full = OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
    full_disk = {"en": "the disk is full", "vi": "đĩa đã đầy"}[language]
    assert full_disk in RefusedChangeError("unwritten", full).in_words(words)
    unknown = OSError(errno.EXDEV, "what the system says")
    assert "what the system says" in RefusedChangeError("unwritten", unknown).in_words(words)


def test_more_rows_than_a_list_takes_are_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """3,000 are told beside their field with the number that is taken; what no form could show is not taken at all."""
    edited = session(tmp_path, catalogue.sample("engine-twin", "en"), "twin.yaml")
    rows = ", ".join(f"{row / 2999:.6f}" for row in range(3000))
    form = put(edited, ("indicator", "s"), rows, list=True)["form"]
    assert re.search(r'<div id="f:indicator.s.d">(?:(?!</div>).)*2000 or fewer', form, re.DOTALL)
    assert 'data-list="2000"' in form
    edited.edit({"op": "undo"})
    before = edited.path.read_bytes()
    for module in (yaml_source, edit_session):
        monkeypatch.setattr(module, "MOST_TOKENS", 2000)
    for count, told in ((900, "too large"), (1100, "0, 0, …")):
        refused = put(edited, ("indicator", "intake"), ", ".join(["0"] * count), list=True)["refused"]
        assert told in refused
        assert len(refused) < 200
    assert edited.path.read_bytes() == before


@contextmanager
def whole_of_two(folder: Path) -> Iterator[EditSession]:
    """A coursework that names a cam beside itself and one outside its folder, and would open both."""
    (work := folder / "work").mkdir()
    for file in (work / "cam.yaml", folder / "cam.yaml"):
        file.write_text(catalogue.sample("cam", "en"), encoding="utf-8")
    whole = session(work, f"{SHAPER}\nparts:\n  - {{file: ../cam.yaml}}\n  - {{file: cam.yaml}}\n")
    parts: list[EditSession] = []

    def of_part(file: Path) -> EditSession:
        parts.append(EditSession(partial(open_case, file), "en", path=file, whole=whole.path))
        return parts[-1]

    whole.of_part = of_part
    yield whole
    for part in parts:
        part.close()


def test_a_part_in_a_file_of_its_own_has_its_own_form(tmp_path: Path) -> None:
    """Its page writes this file alone; the number of a page stays when parts are moved, and ends with the part."""
    with whole_of_two(tmp_path) as whole:
        before = whole.path.read_bytes()
        (page,) = re.findall(r'href="part/(\w+)/"', whole.form())
        part = whole.below(page)
        assert part is not None
        assert part is whole.below(page), "opened once"
        assert "f:parameters.h" in part.form()
        assert 'href="../../"' in part.form()
        put(part, ("parameters", "h"), "41 mm")
        assert "h: 41 mm" in (tmp_path / "work" / "cam.yaml").read_text(encoding="utf-8")
        assert whole.path.read_bytes() == before
        put(part, ("parameters", "h"), "41")
        led = rf'<a href="part/{page}/"><code>cam.yaml:\d+</code>'
        assert re.search(led, whole.form()), "a fault leads there"
        whole.edit({"op": "move", "where": ["parts"], "first": 0})
        assert whole.below(page) is part
        whole.edit({"op": "remove", "where": ["parts", 0]})
        assert whole.below(page) is None


def test_a_part_has_on_its_page_what_it_takes_from_the_machine(tmp_path: Path) -> None:
    """Half of the machine's 89 rpm, not to be typed there; its own page follows the machine."""
    without_speed = re.sub(r"(?m)^  n:.*\n", "", catalogue.sample("cam", "en"))
    (file := tmp_path / "cam.yaml").write_text(without_speed, encoding="utf-8")
    taking = "from: {n: {of: n, times: 1/2}}"
    whole = session(tmp_path, f"{SHAPER}\nparts:\n  - {{file: cam.yaml, {taking}}}\n")
    part = EditSession(partial(open_case, file, "en", whole.path), "en", path=file, whole=whole.path)
    shown = r'<input id="f:parameters.n" value="([^"]*)"[^>]* readonly>'
    assert re.findall(shown, part.form()) == ["44.5 rpm"]
    assert "data-goto" not in part.form()
    assert open_case(file, "en", whole.path).assignment.parameters.n.text == "44.5 rpm"
    put(whole, ("parameters", "n"), "100 rpm")
    assert re.findall(shown, part.form()) == ["50 rpm"]
    put(part, ("parameters", "n"), "60 rpm")
    assert 'aria-invalid="true"' in re.findall(r'id="f:parameters.n"[^>]*', part.form())[0]
    # So it is of one that stands in the coursework's file.
    inside = session(tmp_path, f"{SHAPER}\nparts:\n  - {taking}\n" + re.sub("(?m)^", "    ", without_speed))
    assert re.findall(shown.replace(":p", ":parts.0.p"), inside.form()) == ["44.5 rpm"]
    assert [problem for problem in catalogue.check(inside.path) if problem.level == "error"] == []
    put(inside, ("parts", 0, "from", "n", "times"), "1/4")
    assert re.findall(shown.replace(":p", ":parts.0.p"), inside.form()) == ["22.25 rpm"]


def test_no_page_leads_to_a_part_outside_the_folder(tmp_path: Path) -> None:
    """Neither by a name that leads out, nor by a link that takes the place of a file later."""
    with whole_of_two(tmp_path) as whole:
        (page,) = re.findall(r'href="part/(\w+)/"', whole.form())
        assert all(whole.below(name) is None for name in ("", "..", "2", "cam.yaml"))
        (own := tmp_path / "work" / "cam.yaml").unlink()
        own.symlink_to(tmp_path / "cam.yaml")
        assert whole.below(page) is None
        assert "part/" not in whole.form()


# --- what is chosen -----------------------------------------------------------------------------------


def test_a_kind_is_chosen_and_its_file_begun(tmp_path: Path) -> None:
    """The page names every kind; a kind that is chosen has its file, the second choice is no other one."""
    begun: list[str] = []

    def begins(kind: str, sample: str) -> Path:
        begun.append(kind + sample)
        return tmp_path / f"{kind}.yaml"

    chooser = Chooser(lambda: open_case(tmp_path), "en", begins=begins)
    assert set(re.findall(r'data-kind="([^"]*)"', chooser.page())) == set(kinds())
    chooser.ready.set()
    with pytest.raises(KeyError):
        chooser.begin({"kind": "../shaper"})
    for _ in range(2):
        assert chooser.begin({"kind": "shaper"}) == {"begun": True}
    assert (begun, chooser.path) == (["shaper"], tmp_path / "shaper.yaml")


# --- what is served -----------------------------------------------------------------------------------


@contextmanager
def served(edited: EditSession) -> Iterator[Server]:
    server = Server(edited)
    thread = threading.Thread(target=server.serve_forever, args=(0.01,), daemon=True)
    thread.start()
    yield server
    edited.close()
    server.shutdown()
    server.server_close()


def answered(server: Server, method: str, name: str, headers: dict[str, str], content: str | None = None) -> int:
    """The status of the answer to a request below the secret address; of another one, if `name` begins with `/`."""
    address = urlsplit(server.address)
    with closing(http.client.HTTPConnection(address.netloc, timeout=10)) as connection:
        connection.request(method, name if name.startswith("/") else address.path + name, content, headers)
        return connection.getresponse().status


def own_headers(server: Server) -> dict[str, str]:
    return {"Origin": f"http://{urlsplit(server.address).netloc}", "Content-Type": "application/json"}


def test_the_page_of_a_part_is_served_by_the_same_rules(tmp_path: Path) -> None:
    body = json.dumps({"op": "set", "where": ["parameters", "h"], "value": "41 mm"})
    with whole_of_two(tmp_path) as whole:
        (page,) = re.findall(r'href="(part/\w+/)"', whole.form())
        with served(whole) as server:
            own, wrong = own_headers(server), f"/wrong/{page}"
            assert answered(server, "POST", f"{page}edit.json", {}, body) == 403
            assert answered(server, "POST", f"{wrong}edit.json", own, body) == 404
            assert answered(server, "GET", wrong, {}) == 404
            assert [part for _, part in whole._parts.values() if part] == [], "nothing is opened for them"
            assert answered(server, "GET", page, {}) == 200
            assert answered(server, "GET", "part/7/", {}) == 404
            assert answered(server, "POST", "part/../edit.json", own, body) == 404
            assert answered(server, "POST", f"{page}edit.json", own, body) == 200
    assert "h: 41 mm" in (tmp_path / "work" / "cam.yaml").read_text(encoding="utf-8")
    assert "h: 40 mm" in (tmp_path / "cam.yaml").read_text(encoding="utf-8")


def test_only_its_own_page_may_change_the_file(tmp_path: Path) -> None:
    edited = session(tmp_path)
    with served(edited) as server:
        own, path = own_headers(server), "edit.json"
        body = json.dumps({"op": "set", "where": ["parameters", "a"], "value": "1 mm", "file": "/etc/passwd"})

        def status(name: str, headers: dict[str, str], content: str | None = body) -> int:
            return answered(server, "POST", name, headers, content)

        assert status(path, own | {"Origin": "http://elsewhere.example"}) == 403
        assert status(path, {"Content-Type": "application/json"}) == 403
        assert status(path, own | {"Host": "elsewhere.example"}) == 403
        assert status("/wrong/edit.json", own) == 404
        assert status("other.json", own) == 404
        assert status(path, own | {"Content-Type": "text/plain"}) == 415
        assert status(path, own | {"Content-Length": str(LARGEST + 1)}, None) == 413
        for nonsense in (
            "[]",
            "{",
            '{"op": "set"}',
            '{"op": "set", "where": [], "value": ""}',
            '{"op": "remove", "where": []}',
            '{"op": "write", "where": ["kind"]}',
            '{"op": "set", "where": [[]], "value": 1}',
        ):
            assert status(path, own, nonsense) == 400
        assert edited.path.read_text(encoding="utf-8") == SHAPER
        assert status(path, own) == 200
        assert "a: 1 mm" in edited.path.read_text(encoding="utf-8")
        assert sorted(file.name for file in tmp_path.iterdir()) == ["shaper.yaml"]
