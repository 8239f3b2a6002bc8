"""Words to blocks: what a template says, what a value can never say, and where a fault is."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from reportgen.base.errors import TemplateError
from reportgen.base.template_folders import search_path, templates
from reportgen.base.words import homes
from reportgen.document import (
    BlankLine,
    Block,
    Emph,
    Equation,
    Inline,
    InlineMath,
    LineBreak,
    List,
    PageBreak,
    Paragraph,
    Reference,
    Section,
    Strong,
    Table,
    Text,
    Value,
    template_rendering,
)
from reportgen.document.template_rendering import Prose
from reportgen.formula import Number, Symbol

V_B = Symbol("v", "B")
SPEED = Number(15.708, 2, "m/s")
HOSTILE = "A_B & 100% #1 $x$ \\input{…} *y* {{ 7*7 }} {% if %} `c` [a](b) <b> \n# x\n\n- y\n---\n    z"

NAMES: Mapping[str, object] = {
    "vB": V_B,
    "speed": SPEED,
    "user": HOSTILE,
    "k": 4,
    "equation": Equation((V_B,), "eq.vb"),
    "table": lambda caption: Table((), (), (), caption),
    "nothing": (),
    "entries": {"a": 1},
    "both": (Text("a"), Strong((Text("b"),))),
    "two": [Equation((V_B,)), PageBreak()],
}

UNSAFE = "mẫu không được phép"
Render = Callable[[str], tuple[Block, ...]]


def written(folder: Path, **sections: str) -> Prose:
    """A file `page.md` with these sections; the words of the first begin in line 2."""
    file = folder / "page.md"
    file.write_text("\n".join(f"%% {name}\n{words}" for name, words in sections.items()), encoding="utf-8")
    return Prose((file,))


@pytest.fixture
def render(tmp_path: Path) -> Render:
    further = {"speed": "*speed* of {{ of }}\n", "pages": "\nOne.\n\nTwo: {{ vB }}.\n\n"}

    def rendered(template: str) -> tuple[Block, ...]:
        return written(tmp_path, page=template, **further).render("page", NAMES)

    return rendered


def says(*inlines: str | Inline) -> Paragraph:
    return Paragraph(tuple(Text(part) if isinstance(part, str) else part for part in inlines))


@pytest.mark.parametrize(
    ("template", "expected"),
    [
        ('Một câu – “thử” … "x" -- y & z.', [says('Một câu – “thử” … "x" -- y & z.')]),
        ("two\nlines\n\n    indented", [says("two lines"), says("indented")]),
        ("under\n---\nover", [says("under"), PageBreak(), says("over")]),
        ("a\\\nb", [says("a", LineBreak(), "b")]),
        ("*e* **s *both***", [says(Emph((Text("e"),)), " ", Strong((Text("s "), Emph((Text("both"),)))))]),
        (r"\*plain\* &amp; [x]: y", [says("*plain* &amp; [x]: y")]),
        ("## A *b*", [Section(2, (Text("A "), Emph((Text("b"),))))]),
        ('# A {{ key("s.a") }}', [Section(1, (Text("A"),), "s.a")]),
        ('# A {{ unnumbered() }}{{ key("s") }}', [Section(1, (Text("A"),), "s", numbered=False)]),
        ("### {{ vB }}", [Section(3, (InlineMath(V_B),))]),
        ("- a\n- b\n\n  c", [List(((says("a"),), (says("b"), says("c"))))]),
        ("3. a\n   - b\n4. c", [List(((says("a"), List(((says("b"),),))), (says("c"),)), True, 3)]),
    ],
)
def test_markdown_becomes_the_tree(render: Render, template: str, expected: list[Block]) -> None:
    assert render(template) == tuple(expected)


@pytest.mark.parametrize(
    ("template", "expected"),
    [
        ("{{ vB }} = {{ speed }}", [says(InlineMath(V_B), " = ", Value(SPEED))]),
        ("**{{ k }}**{{ -3 }}", [says(Strong((Text("4"),)), Text("−3"))]),
        ("see {{ ref('eq.' ~ k) }}", [says("see ", Reference("eq.4"))]),
        ("{{ both }}!{{ nothing }}", [says(Text("a"), Strong((Text("b"),)), "!")]),
        ("{{ '*constant*' }}", [says("*constant*")]),
        ("{{ [vB, vB] | join(', ') }}", [says(InlineMath(V_B), ", ", InlineMath(V_B))]),
        ("{{ ['*', k] | join('-') }}", [says("*-4")]),
        ("{{ '1' }}. x", [says("1", ". x")]),
        ("{{ equation }}\n {{ blank('Name') }}", [Equation((V_B,), "eq.vb"), BlankLine("Name")]),
        ("{{ two }}", [Equation((V_B,)), PageBreak()]),
        ("- {{ equation }}\n- b", [List(((Equation((V_B,), "eq.vb"),), (says("b"),)))]),
        (
            "{% for i in range(2) %}\n- {{ vB }} {{ i }}\n{% endfor %}",
            [List(tuple((says(InlineMath(V_B), " ", Text(str(i))),) for i in range(2)))],
        ),
        (
            "{% set of = '*B*' %}The {% include 'speed' %}.",
            [says("The ", Emph((Text("speed"),)), " of ", Text("*B*"), " .")],
        ),
        ("{% include 'pages' %}", [says("One."), says("Two: ", InlineMath(V_B), ".")]),
        (
            "{% for i in [1, 2, 3] if i %}{{ i + 1 }}{{ ';' if not loop.last }}{% endfor %}",
            [says("2", ";", "3", ";", "4")],
        ),
        ("{{ ['b', 'a'] | reverse | join('-') ~ ('X' | lower) ~ [1, 2] | length }}", [says("a-bx2")]),
        ("{{ vB if k == 4 and not nothing else user }}", [says(InlineMath(V_B))]),
        (
            "{% set x %}*em* {{ vB }}{% endset %}\n{{ x ~ '*no*' }}{{ x }}",
            [
                says(
                    *(Emph((Text("em"),)), " ", InlineMath(V_B), Text("*no*")),
                    *(Emph((Text("em"),)), " ", InlineMath(V_B)),
                )
            ],
        ),
        (
            "{% set caption %}*plan* {{ k }}{% endset %}{{ table(inlines(caption)) }}",
            [Table((), (), (), (Emph((Text("plan"),)), Text(" "), Text("4")))],
        ),
        ("{% raw %}{{ x }}{% endraw %}", [says("{{ x }}")]),
    ],
)
def test_values_become_inlines_and_blocks(render: Render, template: str, expected: list[Block]) -> None:
    assert render(template) == tuple(expected)


@pytest.mark.parametrize(
    "template",
    [
        "{{ user }}",
        "{{ [user] | join('') }}",
        "{% for line in [user] %}{{ line }}{% endfor %}",
        "{% set x %}{{ user }}{% endset %}{% set y %}{{ x }}{% endset %}{{ y }}",
        "{% set x %}{% endset %}{{ x ~ user }}",
        "{% set x %}{% endset %}{{ x + user }}",
        "{% set x %}{{ user }}{% endset %}{{ x }}",
        "{% set x %}{% endset %}{{ [x, user] | join('') }}",
    ],
)
def test_a_hostile_text_stays_text_by_any_way(render: Render, template: str) -> None:
    assert render(template) == (says(HOSTILE),)


def one_item(folder: Path) -> Prose:
    return written(folder, one="- *x* {{ user }}y\n")


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=200, deadline=None)
@given(user=st.text(min_size=1) | st.text(st.characters(categories=("Co", "Nd", "Cc", "Zs"))).filter(bool))
def test_any_text_survives_as_one_inline(tmp_path: Path, user: str) -> None:
    """Any string at all, private-use characters among them, arrives unchanged as exactly one Text."""
    blocks = one_item(tmp_path).render("one", {"user": user})
    assert blocks == (List(((says(Emph((Text("x"),)), " ", Text(user), "y"),),)),)


def test_a_text_cannot_imitate_a_token(render: Render, tmp_path: Path) -> None:
    forged = "\ue0000\ue001 \ue000:0\ue001 \ue002*x*\ue003*y*\ue004"
    assert one_item(tmp_path).render("one", {"user": forged}) == (
        List(((says(Emph((Text("x"),)), " ", Text(forged), "y"),),)),
    )
    with pytest.raises(TemplateError, match=r"page\.md:3: .*riêng"):
        render("a\nb \ue000")


@pytest.mark.parametrize(
    ("template", "line", "words"),
    [
        ("a\n\n{{ nope }}", 3, "'nope' is undefined"),
        ("a\n{% if nope %}x{% endif %}", 2, "'nope' is undefined"),
        ("a\n{{ vB.nope }}", 2, "nope"),
        ("a\n\n{% if %}", 3, "Expected an expression"),
        ("a\n{% for i in [1] %}\n", 2, "Unexpected end of template"),
        ("a\n{{ k | nope }}", 2, UNSAFE),
        ("a\n{{ both['x'].y }}", 2, "there is no x"),
        ("a\n\n{{ table() }}", 3, "TypeError"),
        ("a\n{{ broken('b') }}", 2, "'broken' is undefined"),
        ("\n{{ 1.5 }}", 2, "1.5 has no place in words"),
        ("\n{{ none }}", 2, "None has no place in words"),
        ("\n{{ true }}", 2, "True has no place in words"),
        ("\n{{ {'a': 1} }}", 2, UNSAFE),
        ("\n{{ entries }}", 2, "dict has no place in words"),
        ("\n{{ table }}", 2, "function has no place in words"),
        ("a\nb\nc {{ equation }}\nd", 3, "Equation stands within running text"),
        ("a\n\n*{{ equation }}*", 3, "Equation stands within running text"),
        ("# A {{ equation }}", 1, "Equation stands within running text"),
        ("{% for i in [1, 2] %}\nx\n\ny {{ blank() }}\n{% endfor %}", 4, "BlankLine stands within"),
        ("a\n{{ key('x') }}", 2, "end of a heading"),
        ("# {{ key('x') }} a", 1, "end of a heading"),
        ("{% set x %}x{% endset %}\n{{ ref(x) }}", 2, "plain string"),
        ("a\n\nb `code`", 3, "inline code"),
        ("a\n\n[b](c)", 3, "a link"),
        ("a\n\n<http://c.d>", 3, "a link"),
        ("a\n\n![b](c)", 3, "an image"),
        ("a\n\nb <i>c</i>", 3, "HTML"),
        ("a\n\n<div>\n</div>", 3, "HTML"),
        ("a\n\n```\nb\n```", 3, "a code block"),
        ("a\n\n> b", 3, "a quotation"),
        ("a\n\n- b\n- c `d`", 4, "inline code"),
        ("{% for i in [1, 2] %}\n- a\n{% endfor %}\n\nb `d`", 5, "inline code"),
        ("a\n\n##### b", 3, "level 5"),
        ("a\n{% include 'none' %}", 2, "no section none"),
        ("a\n{% set x %}long enough to be cut{% endset %}{{ x[2:9] }}", 2, "neither cut"),
        ("a\n{% set x %}b{% endset %}{% if '1' in x %}{% endif %}", 2, "nor compared"),
        ("a\n{% set x %}b{% endset %}{% if x < '1' %}{% endif %}", 2, "nor compared"),
        ("a\n{{ ref(vB) }}", 2, "Symbol has no place in a text"),
        ("a\n{{ " + "9" * 4000 + " }}", 2, UNSAFE),
        ("a\n{% set x = 999999999999999 %}{% set x = x + x %}", 2, "có nhiều hơn"),
        ("a\n{{ '\\x01' }}", 2, "ký tự điều khiển"),
        ("a\n{{ '\\ud800' }}", 2, "ký tự điều khiển"),
        ("a\n{{ vB ~ 'x' }}", 2, "Symbol has no place in a text"),
        ("a\n{{ vB.sub }}", 2, "there is no sub"),
        ("a\n{% for x in vB %}{% endfor %}", 2, "Symbol is no list"),
        ("a\n{{ both + k }}", 2, "have no sum"),
    ],
)
def test_a_fault_names_file_and_line(render: Render, template: str, line: int, words: str) -> None:
    """The line of the file, not of the section, whose words begin below its heading."""
    with pytest.raises(TemplateError) as caught:
        render(template)
    message = str(caught.value)
    assert f"page.md:{line + 1}: " in message
    assert words in message


def test_what_stands_for_the_number_of_a_mark_is_a_text(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Also in another process, which reads what this one has kept."""
    kept: dict[str, bytes] = {}
    monkeypatch.setattr(template_rendering, "keep", kept.__setitem__)
    monkeypatch.setattr(template_rendering, "kept", kept.get)
    for _ in range(2):
        monkeypatch.setattr(template_rendering, "_compiled", template_rendering._Compiled())
        template_rendering._environment.cache_clear()
        number = template_rendering.NUMBER.decode()
        assert written(tmp_path, one=f"a {{{{ '{number}' }}}} {number}").render("one", {}) == (
            says("a ", Text(number), f" {number}"),
        )
    template_rendering._environment.cache_clear()


def test_a_fault_in_a_called_function_is_placed_where_it_is_called(tmp_path: Path) -> None:
    def broken(name: str) -> object:
        return {"a": 1}[name]

    template_rendering = written(tmp_path, page="\n\n{{ broken('b') }}")
    with pytest.raises(TemplateError, match=r"page\.md:4: KeyError: 'b'"):
        template_rendering.render("page", {"broken": broken})
    with pytest.raises(TemplateError, match=r"page\.md:1: there is no section other"):
        template_rendering.render("other", {})


def test_equal_words_have_their_own_values_and_places(tmp_path: Path) -> None:
    first, second = (written(tmp_path, page="A {{ user }}.") for _ in range(2))
    assert first.render("page", {"user": "b"}) == (says("A ", Text("b"), "."),)
    assert second.render("page", {"user": "c"}) == (says("A ", Text("c"), "."),)
    wrong = "{{ equation }} b"
    prose = written(tmp_path, page=wrong, other=wrong)
    for name, line in (("page", 2), ("other", 4)):
        with pytest.raises(TemplateError, match=rf"page\.md:{line}: "):
            prose.render(name, NAMES)


def test_a_function_may_render_another_template(tmp_path: Path) -> None:
    """A rendering within a rendering keeps its values apart."""
    template_rendering = written(tmp_path, outer="{{ 'a' }}\n\n{{ inner() }}\n\n{{ 'c' }}", inner="{{ 'b' }}")
    blocks = template_rendering.render("outer", {"inner": lambda: template_rendering.render("inner", {})})
    assert blocks == (says("a"), says("b"), says("c"))


def test_a_plain_string_is_a_caption_too(tmp_path: Path) -> None:
    assert Prose((tmp_path,)).inlines(HOSTILE) == (Text(HOSTILE),)
    assert Prose((tmp_path,)).inlines("") == ()


def test_a_caption_is_one_line(render: Render) -> None:
    with pytest.raises(TemplateError, match=r"page\.md:\d: one line of words is wanted"):
        render("{% set x %}a\n\nb{% endset %}\n{{ inlines(x) }}")


def test_the_nearest_words_win(tmp_path: Path) -> None:
    """A school's section before the machine's, that before the common one; by the section's name."""
    path = search_path("vi", kind="engine", school="school", root=tmp_path)
    for place, names in zip(path, ("a", "ab", "abc"), strict=True):
        file, _ = next(homes("a", place))
        file.parent.mkdir(parents=True, exist_ok=True)
        where = file.relative_to(tmp_path)
        file.write_text("\n".join(f"%% {name}\n{where}\n" for name in names), encoding="utf-8")
    template_rendering = Prose(path)
    found = [template_rendering.render(name, {}) for name in "abc"]
    assert found == [(says("school/vi.md"),), (says("vi/catalogue/engine.md"),), (says("vi/report.md"),)]
    assert search_path("en", root=tmp_path) == (tmp_path / "en",)


def test_the_templates_are_found() -> None:
    assert (templates() / "vi").is_dir()


def test_a_template_changed_between_reports_is_read_again(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    for second, word in enumerate(("one", "two")):
        template_rendering = written(tmp_path, page=word)
        os.utime(page, (second, second))
        assert template_rendering.render("page", {}) == (Paragraph((Text(word),)),)


def test_words_that_come_nearer_are_seen(tmp_path: Path) -> None:
    """Also while the environment of the search path is kept."""
    path = search_path("vi", school="school", root=tmp_path)
    for place, word in ((path[1], "one"), (path[0], "two")):
        file, _ = next(homes("page", place))
        file.parent.mkdir()
        file.write_text(f"%% page\n{word}\n", encoding="utf-8")
        assert Prose(path).render("page", {}) == (says(word),)
