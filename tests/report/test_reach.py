"""What a template can reach: a walk over all that it can name, and attempts that nobody thought of."""

from __future__ import annotations

import gc
import random
import re
from collections.abc import Iterator, Mapping
from functools import cache
from itertools import chain, product
from pathlib import Path
from typing import Any

import pytest

from reportgen import api
from reportgen.base.errors import TemplateError
from reportgen.base.records import field_names
from reportgen.base.template_access import MEMBERS
from reportgen.cases import opened
from reportgen.document.template_language import FILTERS
from reportgen.document.template_rendering import GLOBALS, Prose, _reason
from reportgen.document.template_values import PLAIN, FunctionToken, Token, Values, held
from tests.lanes import matrix

ASSIGNMENTS = Path(__file__).parents[2] / "assignments"
FILES = (
    *("slider-crank-01.yaml", "shaper-01.yaml", "linkage-8.yaml", "engine-twin-05.yaml"),
    *("plane-motion/01.yaml", "cam/roller-01.yaml", "gears/pair-equal-sliding.yaml", "gears/train-motor.yaml"),
)
Names = Mapping[str, Any]


@cache
def handed(file: str) -> tuple[Values, Names]:
    """What the templates of an assignment's report hold by their names, and what its tokens stand for."""
    found: list[tuple[Values, Names]] = []
    render = Prose.render

    def noted(prose: Prose, name: str, names: Mapping[str, object]) -> Any:
        found.append((prose.values, prose.values.names({**GLOBALS, **names})))
        return render(prose, name, names)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Prose, "render", noted)
        opened(api.load(ASSIGNMENTS / file)).document()
    return found[-1]


def reached(values: Values, names: Names) -> Iterator[Any]:
    """All that a template gets by members, entries and items, each token once.

    It begins with its names and with all that any section of the report has been handed, also by functions.
    """
    waiting, met = [*names.values(), *values._tokens.values()], set[int]()
    while waiting:
        value = waiting.pop()
        yield value
        if isinstance(value, tuple):
            waiting += value
        elif isinstance(value, Token) and value.number not in met:
            met.add(value.number)
            waiting += [] if isinstance(value, FunctionToken) else members(values, value)


def members(values: Values, token: Token) -> list[Any]:
    return [one for name in values.members(token) if (one := member(values, token, name)) is not None]


def member(values: Values, token: Token, name: str) -> Any:
    try:
        return values.member(token, name)
    except AssertionError:  # a group without a force plan has none of its vertices
        return None


@pytest.mark.parametrize("file", matrix(FILES, FILES[:1] + FILES[4:6]))
def test_all_that_a_template_reaches_is_plain(file: str) -> None:
    values, names = handed(file)
    kinds = {type(value) for value in reached(values, names)}
    assert kinds <= {*PLAIN, tuple, Token, FunctionToken}
    assert {str, int, Token, FunctionToken} <= kinds


@pytest.mark.parametrize("file", matrix(FILES, FILES[:1]))
def test_nothing_of_it_refers_to_an_object_of_the_program(file: str) -> None:
    """Not even by what Python itself knows of it: the references that its collector follows, classes left aside."""
    values, names = handed(file)
    waiting: list[Any] = [*reached(values, names)]
    met = set[int]()
    while waiting:
        value = waiting.pop()
        if id(value) in met or isinstance(value, type):
            continue
        met.add(id(value))
        assert type(value) in {*PLAIN, tuple, Token, FunctionToken}
        waiting += gc.get_referents(value)


@pytest.mark.parametrize("file", matrix(FILES, FILES[:1]))
def test_what_functions_give_is_plain_too(file: str, monkeypatch: pytest.MonkeyPatch) -> None:
    given, call = set[type](), Values.call

    def noted(values: Values, called: Any, arguments: Any, named: Any) -> Any:
        result = call(values, called, arguments, named)
        given.add(type(result))
        return result

    monkeypatch.setattr(Values, "call", noted)
    opened(api.load(ASSIGNMENTS / file)).document()
    assert given <= {*PLAIN, tuple, Token}
    assert Token in given


INSIDE = re.compile(r"\w\(\w+=|\w\(\(|\w\(\w+\(| at 0x|<class|<function|partial\(|array\(|\{'|\{\d")
"""What Python writes of objects and of mappings."""


@pytest.mark.parametrize("file", matrix(FILES, FILES[:1]))
def test_functions_show_nothing_of_the_inside_of_what_they_are_given(file: str) -> None:
    """Every function that a template reaches is called with a token of every type, alone and beside others."""
    values, names = handed(file)
    found = [*reached(values, names)]
    functions = [one for one in found if isinstance(one, FunctionToken)]
    tokens = {type(values.own(one)): one for one in found if isinstance(one, Token)}
    outer = held.set(values)
    try:
        for function, token in product(functions, tokens.values()):
            for arguments in ((token,), ("v", token), (token, token), ((token,), token)):
                assert not INSIDE.search(told_by(values, function, arguments)), (values.own(function), arguments)
    finally:
        held.reset(outer)


def told_by(values: Values, function: FunctionToken, arguments: tuple[Any, ...]) -> str:
    """The texts in what a function gives, or in what is told of its fault."""
    try:
        return " ".join(texts(values.own(values.call(function, arguments, {}))))
    except Exception as error:
        return _reason(error, ())


def texts(of: Any) -> Iterator[str]:
    """All texts of a tree."""
    if isinstance(of, str):
        yield of
    elif isinstance(of, (tuple, list)):
        yield from chain.from_iterable(map(texts, of))
    else:
        yield from chain.from_iterable(texts(getattr(of, name, None)) for name in field_names(type(of)))


def test_a_token_tells_nothing_and_is_no_function() -> None:
    values = Values()
    outer = held.set(values)
    try:
        token = values.plain(Path())
        assert (str(token), repr(token), f"{token}") == ("Token", "Token", "Token")
        assert not hasattr(token, "__dict__")
        assert list(values.members(token)) == []
        with pytest.raises(LookupError):
            values.member(token, "parent")
    finally:
        held.reset(outer)


def test_every_member_that_is_shown_exists() -> None:
    for file in FILES:
        handed(file)
    for kind, names in MEMBERS.items():
        fields = {*getattr(kind, "__dataclass_fields__", ()), *getattr(kind, "model_fields", ())}
        # What a view sets when it is made stands in no class.
        made = getattr(vars(kind).get("__init__"), "__code__", None)
        made = made.co_names if made else ()
        assert {name for name in names if name not in fields and not hasattr(kind, name) and name not in made} == set()


# --- attempts by a generator ------------------------------------------------------------------------

SECRET = "nobody-reads-this"
DUNDERS = ("__class__", "__init__", "__globals__", "__builtins__", "__mro__", "__subclasses__", "__self__", "__dict__")
HIDDEN = ("gi_frame", "f_builtins", "f_globals", "func", "args", "ledger", "case", "values", "numbers", "prose", "mro")
JINJA = ("self", "super", "caller", "cycler", "joiner", "namespace", "lipsum", "dict", "loop", "varargs", "kwargs")
FILTERED = (
    "attr",
    "map",
    "string",
    "format",
    "list",
    "tojson",
    "pprint",
    "xmlattr",
    "groupby",
    "sort",
    "select",
    "join",
)


class Attempts:
    """Templates made at random of what has ever led out of a sandbox."""

    def __init__(self, seed: int, names: Names, secret: Path) -> None:
        self.of, self.names, self.secret = random.Random(seed), sorted(names), secret

    def expression(self, depth: int = 3) -> str:
        one, of = self.of.choice, self.of
        if depth == 0:
            return one([one(self.names), one(JINJA), "1", f"'{one(DUNDERS)}'", "[1]", "''", "range(3)", "words"])
        inner = self.expression(depth - 1)
        return one(
            [
                f"{inner}.{one(DUNDERS + HIDDEN)}",
                f"{inner}['{one(DUNDERS + HIDDEN)}']",
                f"{inner}[{of.randrange(-2, 9)}:{of.randrange(9)}]",
                f"({inner}|{one(FILTERED + tuple(FILTERS))})",
                f"({inner}|attr('{one(DUNDERS)}'))",
                f"({inner}|map(attribute='{one(DUNDERS + HIDDEN)}')|list)",
                f"'{{0.{one(DUNDERS)}}}{{0[{one(HIDDEN)}]!r}}'.format({inner})",
                f"('%s %r' % ({inner}, {one(self.names)}))",
                f"say('{{{one(DUNDERS + HIDDEN)}}}{{{one(self.names)}}}', {inner})",
                f"say('{{{one(HIDDEN)}.{one(DUNDERS)}}}', {one(self.names)}, {one(HIDDEN)}={inner})",
                f"say({inner}, {one(self.names)})",
                f"ref('fig', {inner}, {one(self.names)})",
                f"letters('x', {inner}, {one(self.names)})",
                f"({inner} < {one(self.names)} or '1' in {inner})",
                f"({'9' * of.randrange(1, 5000)} + {inner})",
                f"counted('groups', {inner}, list={one(self.names)})",
                f"{one(self.names)}({inner}, {self.expression(depth - 1)})",
                f"{one(self.names)}(*{inner}, **words)",
                f"({inner} ~ {one(self.names)} ~ {self.expression(depth - 1)})",
                f"({inner} + {self.expression(depth - 1)})",
                f"({inner} if {self.expression(depth - 1)} else {one(self.names)})",
                f"[{inner}, {one(self.names)}]|join({inner})",
            ]
        )

    def statement(self) -> str:
        one, inner = self.of.choice, self.expression(self.of.randrange(1, 4))
        section = one([str(self.secret.with_suffix("")) + "/section", "../../secret/section", "foreword", "words"])
        return one(
            [
                f"{{{{ {inner} }}}}",
                f"{{{{ {inner} }}}}",
                f"{{% for a in {inner} %}}{{% for b in a %}}{{{{ b }}}}{{% endfor %}}{{{{ loop ~ a }}}}{{% endfor %}}",
                "{% for a in range(9999) %}{% for b in range(9999) %}"
                + f"{{{{ {inner} }}}}"
                + "{% endfor %}{% endfor %}",
                f"{{% for a in [1] recursive %}}{{{{ loop([{inner}]) }}}}{{% endfor %}}",
                f"{{% macro m(x) %}}{{{{ m({inner}) }}}}{{% endmacro %}}{{{{ m(1) }}}}",
                f"{{% call {one(self.names)}({inner}) %}}{{{{ caller.{one(DUNDERS)} }}}}{{% endcall %}}",
                f'{{% include "{section}" %}}',
                f"{{% include {inner} %}}",
                f'{{% extends "{section}" %}}',
                f'{{% from "{section}" import a %}}{{{{ a.{one(DUNDERS)} }}}}',
                f"{{% block a %}}{{{{ self.a() }}}}{{{{ super() }}}}{{{{ {inner} }}}}{{% endblock %}}",
                f"{{% set a = namespace(b={inner}) %}}{{% set a.b = a %}}{{{{ a.b.b }}}}",
                f"{{% set a = {inner} %}}" + "{% set a = a ~ a %}" * 40 + "{{ a }}",
                f"{{% set a = {inner} %}}" + "{% set a = a + a %}" * 40 + "{{ a }}",
                f"{{% with a = {inner} %}}{{{{ a }}}}{{% endwith %}}",
                f"{{% filter {one(FILTERED)} %}}{{{{ {inner} }}}}{{% endfilter %}}",
                f"{{% set a %}}b{{{{ {inner} }}}}{{% endset %}}{{% if '1' in a %}}{{{{ a }}}}{{% endif %}}",
                f"{{% set a %}}b{{{{ {inner} }}}}{{% endset %}}{{{{ {one(self.names)}(a) }}}}",
                "{% for a in [1] %}" * self.of.randrange(1, 60) + f"{{{{ {inner} }}}}" + "{% endfor %}",
                "*" * self.of.randrange(5000) + f"{{{{ {inner} }}}}" + "*" * 3000,
                "{{ " + "(" * self.of.randrange(9000) + inner + " }}",
                f"{{% if {inner} %}}" * self.of.randrange(1, 300),
            ]
        )


ATTEMPTS = 200


@pytest.mark.parametrize("part", matrix(range(10), [0]))
def test_attempts_at_random_neither_run_nor_leak(part: int, tmp_path: Path) -> None:
    """Each is rendered with all the names of a report, and comes to words or to a located fault."""
    secret = tmp_path / "secret.md"
    secret.write_text(f"%% section\n{SECRET}\n", encoding="utf-8")
    case = opened(api.load(ASSIGNMENTS / FILES[0]))
    seen: list[Mapping[str, object]] = []
    render = Prose.render

    def noted(prose: Prose, name: str, names: Mapping[str, object]) -> Any:
        seen.append(names)
        return render(prose, name, names)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Prose, "render", noted)
        case.document()
    names = {**GLOBALS, **seen[-1]}
    for number in range(part, ATTEMPTS, 10):
        attempts = Attempts(number, names, secret)
        page = tmp_path / f"words-{number}" / "en" / "report.md"
        page.parent.mkdir(parents=True)
        page.write_text(f"%% page\n{attempts.statement()}\n", encoding="utf-8")
        try:
            told = " ".join(texts(Prose((page.parent,)).render("page", seen[-1])))
        except TemplateError as error:
            told = str(error)
            assert told.startswith((str(page), str(ASSIGNMENTS.parent))), (number, told)
        assert SECRET not in told, number
        assert not INSIDE.search(told), (number, told)
