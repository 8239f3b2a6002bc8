"""The template language: names, members, calls, conditions, loops and included sections; nothing else.

A template is checked when it is read: syntax outside this language is a fault with its line. The rest works only on
the values of a template (`values.py`), and loops and texts have size limits. Functions of this module replace Jinja's
default operations: join texts, iterate over lists, look up a section.
"""

from __future__ import annotations

from collections.abc import Callable, Container, Iterable, Mapping
from itertools import chain
from typing import Any

from jinja2 import Environment, TemplateSyntaxError, Undefined, nodes
from jinja2.runtime import Context, LoopContext
from jinja2.visitor import NodeTransformer

from reportgen.document.markdown import SECRET
from reportgen.document.template_values import Token, held

LONGEST = 400_000
"""Characters of a text, as many as a file of templates may have bytes."""
MOST_ITEMS = 10_000
"""Items of a list, and numbers of a range."""
MOST_STEPS = 100_000
"""Steps of all loops of a section; 720 positions of a report have a tenth of them."""

LARGEST_NUMBER = 10**15
"""Whole numbers of a template, which count and number things."""

SIGNS = frozenset(
    (
        *(nodes.Template, nodes.Output, nodes.TemplateData, nodes.Include),
        *(nodes.If, nodes.For, nodes.Assign, nodes.AssignBlock),
        *(nodes.Name, nodes.Const, nodes.Tuple, nodes.List, nodes.Getattr, nodes.Getitem, nodes.Slice),
        *(nodes.Call, nodes.Keyword, nodes.Filter, nodes.CondExpr, nodes.Not, nodes.And, nodes.Or),
        *(nodes.Compare, nodes.Operand, nodes.Concat, nodes.Add, nodes.Sub, nodes.Neg),
    )
)
"""Node types that a template may contain."""
OF_JINJA = frozenset(("self", "super", "caller", "varargs", "kwargs"))
"""Names by which Jinja gives access to its internal objects."""


class TooMuchError(Exception):
    """A text or a list is longer, or loops go on for longer, than a template may."""


class UnknownSignError(TemplateSyntaxError):
    """A template has a sign that is not in the language."""


class Dialect(Environment):
    """Jinja with the language of templates: it checks each parsed template, rewrites its operations, and compiles it.

    `filters` extend those of the language; `options` are those of `jinja2.Environment`. A template can be rendered only
    while the context variable `held` contains its `Values`.
    """

    sandboxed = True  # calls go by way of `call`
    intercepted_binops: frozenset[str] = frozenset()
    intercepted_unops: frozenset[str] = frozenset()

    def __init__(self, filters: Mapping[str, Callable[..., Any]], **options: Any) -> None:
        super().__init__(**options)
        self.known = {**FILTERS, **filters}
        self.filters, self.tests, self.globals = {**self.known, **OWN}, {}, {}

    def _parse(self, source: str, name: str | None, filename: str | None) -> nodes.Template:
        tree = super()._parse(source, name, filename)
        for node in chain([tree], tree.find_all(nodes.Node)):
            if not _is_known(node, self.known):
                raise UnknownSignError("", node.lineno, name, filename)
        return tree

    def _generate(self, source: nodes.Template, *arguments: Any, **named: Any) -> str:
        rewritten = _Rewriting(self).visit(source)
        return super()._generate(rewritten, *arguments, **named)

    def getattr(self, obj: Any, attribute: str) -> Any:
        return self.getitem(obj, attribute)

    def getitem(self, obj: Any, argument: Any) -> Any:
        """Return a member or an entry of a token's value, or an item of a list or a text."""
        try:
            if isinstance(obj, Token):
                return held.get().member(obj, argument)
            if isinstance(obj, (tuple, str)) and isinstance(argument, int):
                return _whole(obj)[argument]
        except LookupError:
            pass
        if isinstance(obj, Undefined):
            str(obj)
        return self.undefined(hint=f"there is no {_type_name(argument)} here", name=_type_name(argument))

    def call(self, _context: Context, called: Any, /, *arguments: Any, **named: Any) -> Any:
        """Return the result of a function of the table; the variables of a loop, which Jinja adds, are removed."""
        for variables in ("_loop_vars", "_block_vars"):
            named.pop(variables, None)
        return held.get().call(called, arguments, named)


def _is_known(node: nodes.Node, filters: Container[str]) -> bool:
    """Return True if a node is in the language."""
    match node:
        case nodes.Call():
            named = isinstance(node.node, (nodes.Name, nodes.Getattr))
            return named and node.dyn_args is None and node.dyn_kwargs is None
        case nodes.Filter():
            whole = node.node is not None and node.dyn_args is None and node.dyn_kwargs is None
            return whole and node.name in filters
        case nodes.Name(name=name) | nodes.Getattr(attr=name):
            return not name.startswith("_") and name not in OF_JINJA
        case nodes.Const(value=int(number)):
            return number <= LARGEST_NUMBER
        case nodes.Keyword(key=name):
            return not name.startswith("_")
        case nodes.For():
            return not node.recursive
        case nodes.AssignBlock():
            return node.filter is None
        case nodes.Include():
            return bool(node.with_context) and not node.ignore_missing
    return type(node) in SIGNS


class _Rewriting(NodeTransformer):
    """Replace Jinja's operations on objects by the functions in `OWN`, whose names no template can write."""

    def __init__(self, environment: Environment) -> None:
        self.environment = environment

    def _by(self, name: str, of: Any) -> nodes.Filter:
        filtered = nodes.Filter(of, f" {name}", [], [], None, None, lineno=of.lineno)
        filtered.set_environment(self.environment)
        return filtered

    def _list(self, *items: Any) -> nodes.Tuple:
        made = nodes.Tuple(list(items), "load", lineno=items[0].lineno)
        made.set_environment(self.environment)
        return made

    def visit_Concat(self, node: nodes.Concat) -> nodes.Node:
        self.generic_visit(node)
        return self._by("joined", self._list(*node.nodes))

    def visit_Add(self, node: nodes.Add) -> nodes.Node:
        self.generic_visit(node)
        return self._by("sum", self._list(node.left, node.right))

    def visit_Sub(self, node: nodes.Sub) -> nodes.Node:
        self.generic_visit(node)
        return self._by("difference", self._list(node.left, node.right))

    def visit_List(self, node: nodes.List) -> nodes.Node:
        self.generic_visit(node)
        return nodes.Tuple(node.items, "load", lineno=node.lineno).set_environment(self.environment)

    def visit_Compare(self, node: nodes.Compare) -> nodes.Node:
        self.generic_visit(node)
        node.expr = self._value(node.expr)
        for operand in node.ops:
            operand.expr = self._value(operand.expr)
        return node

    def _value(self, node: nodes.Expr) -> nodes.Expr:
        return node if isinstance(node, nodes.Const) else self._by("value", node)

    def visit_Getitem(self, node: nodes.Getitem) -> nodes.Node:
        self.generic_visit(node)
        if not isinstance(node.arg, nodes.Slice):
            return node
        ends = (node.arg.start, node.arg.stop, node.arg.step)
        none = nodes.Const(None, lineno=node.lineno).set_environment(self.environment)
        return self._by("part", self._list(node.node, *(end or none for end in ends)))

    def visit_For(self, node: nodes.For) -> nodes.Node:
        self.generic_visit(node)
        node.iter = self._by("items", node.iter)
        return node

    def visit_Include(self, node: nodes.Include) -> nodes.Node:
        self.generic_visit(node)
        if not isinstance(node.template, nodes.Const) or not isinstance(node.template.value, str):
            node.template = self._by("section", node.template)
        return node

    def visit_Name(self, node: nodes.Name) -> nodes.Node:
        return self._by("place", node) if node.name == "loop" and node.ctx == "load" else node


# --- operations on values ---------------------------------------------------------------------------


def short(text: str) -> str:
    """Return the text; raise `TooMuchError` if it is longer than a text may be."""
    if len(text) > LONGEST:
        raise TooMuchError
    return text


def _joined(parts: Iterable[Any]) -> str:
    """Return `a ~ b`: texts, whole numbers, and values that have a text are joined."""
    return short("".join(map(held.get().text, parts)))


def _number(value: Any) -> Any:
    own = held.get().own(value)
    return int(own) if isinstance(own, int) and not isinstance(own, bool) else own


def _bounded(number: int) -> int:
    if abs(number) > LARGEST_NUMBER:
        raise TooMuchError
    return number


def _sum(of: tuple[Any, Any]) -> Any:
    """Return `a + b` of two numbers, two texts, or two lists."""
    match tuple(map(_number, of)):
        case int(a), int(b):
            return _bounded(a + b)
        case str(a), str(b):
            return short(a + b)
        case tuple(a), tuple(b) if len(a) + len(b) <= MOST_ITEMS:
            return held.get().plain(a + b)
        case tuple(), tuple():
            raise TooMuchError
        case a, b:
            raise TypeError(f"a {type(a).__name__} and a {type(b).__name__} have no sum")


def _difference(of: tuple[Any, Any]) -> int:
    match tuple(map(_number, of)):
        case int(a), int(b):
            return _bounded(a - b)
        case a, b:
            raise TypeError(f"a {type(a).__name__} and a {type(b).__name__} have no difference")
    raise AssertionError


def _items(of: Any) -> tuple[Any, ...]:
    """Return the items that a loop iterates over, and count its steps."""
    values = held.get()
    items = values.items(of)
    values.steps += len(items)
    if values.steps > MOST_STEPS:
        raise TooMuchError
    return items


def _part(of: tuple[Any, ...]) -> Any:
    """Return `a[b:c]` of a text or a list."""
    value, *ends = of
    if not isinstance(value, (str, tuple)):
        raise TypeError(f"a {_type(value)} has no parts")
    return _whole(value)[slice(*ends)]


def _whole(value: Any) -> Any:
    """Return the value; raise `ValueError` if it contains a piece of the template, which has marks."""
    if isinstance(value, str) and SECRET in value:
        raise ValueError("a piece of the template is neither cut nor compared")
    return value


def _type(value: Any) -> str:
    return type(held.get().own(value)).__name__


def _section(name: Any) -> str:
    """Return the name of an included section as text; raise like `Values.text`."""
    return held.get().text(name)


def _place(loop: Any) -> Any:
    """Return the place in a loop as plain values: first, last, index, index0, length."""
    if not isinstance(loop, LoopContext):
        return loop
    return held.get().plain({name: getattr(loop, name) for name in ("first", "last", "index", "index0", "length")})


OWN = {
    " joined": _joined,
    " sum": _sum,
    " difference": _difference,
    " items": _items,
    " part": _part,
    " value": _whole,
    " section": _section,
    " place": _place,
}


# --- the filters of the language --------------------------------------------------------------------


def _lower(text: Any) -> str:
    return held.get().text(text).lower()


def _upper(text: Any) -> str:
    return held.get().text(text).upper()


def _listed(of: Any) -> tuple[Any, ...]:
    return held.get().items(of)


def _reverse(of: Any) -> tuple[Any, ...]:
    return _listed(of)[::-1]


def _length(of: Any) -> int:
    return len(of) if isinstance(of, str) else len(_listed(of))


def _with(of: Any, name: str) -> tuple[Any, ...]:
    """Return the items of a list for which a member counts as true."""
    return tuple(one for one in _listed(of) if held.get().member(one, name))


FILTERS: Mapping[str, Callable[..., Any]] = {
    "lower": _lower,
    "upper": _upper,
    "list": _listed,
    "reverse": _reverse,
    "length": _length,
    "selectattr": _with,
}


def numbers(*ends: int) -> tuple[int, ...]:
    """Return the whole numbers of a range with the arguments of Python's `range`: `numbers(1, 4)` is (1, 2, 3).

    Raises `TooMuchError` for more than `MOST_ITEMS`.
    """
    numbers = range(*map(int, ends))
    if len(numbers) > MOST_ITEMS:
        raise TooMuchError
    return tuple(numbers)


def _type_name(name: Any) -> str:
    return name if isinstance(name, str) else type(name).__name__
