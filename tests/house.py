"""Measure the package structure: its rooms, floors and imports, with limits that must not be exceeded.

    python -m tests.house

prints every figure beside its limit and exits with code 1 if a figure exceeds it.  Numbers of rooms, floors
and arrows are printed without a limit: a cap that equals today's figure punishes any good addition, too.

A room is a folder of `reportgen` with all that is in it, or a module beside those folders.  An arrow runs from a room
to another one that it imports from, wherever the import stands.  A room is a floor above the highest that it imports.
"""

from __future__ import annotations

import ast
import re
import sys
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

ROOT = Path(__file__).parents[1]
SHOWN = 8
"""Largest number of places shown for a figure that exceeds its limit."""
ID_HEADS = (
    "v|a|seg|R|F|mu|drawn|l|m|J|h|M|dir|turn|omega|eps|phi|ic|plan|laid|p|f|G|Pqt|x|s|e|link|guide|rate|side"
    "|alpha|centre|k|share|way|cam"
)
"""Prefixes of the ids of quantities, before their first dot."""
_ID = re.compile(rf"({ID_HEADS})\.")
_CAMEL_CASE = re.compile(r"[A-Z](?=.*[a-z])[A-Za-z0-9]*")
VAGUE = {"one", "other", "found", "told", "way", "shown"}
"""Names without a meaning."""
PUBLIC = {
    # keys of assignment files
    "reportgen.catalogue.declared_loads": {"way"},
    "reportgen.springs.topic": {"other"},
    # keys of title blocks
    "reportgen.sheets.title_block": {"other"},
    # members that templates read
    "reportgen.derivation.equation_sides": {"shown", "way"},
    "reportgen.exercise.solution_page": {"way"},
    "reportgen.exercise.views": {"one", "other", "way"},
    "reportgen.catalogue.linkage_words": {"way"},
    "reportgen.report.link_views": {"one"},
}
"""Vague names that modules must keep, because files or templates contain them."""

Graph = Mapping[str, frozenset[str]]
"""The successors of each node."""


@dataclass(frozen=True)
class Module:
    """A module by its dotted name."""

    name: str
    path: Path

    @cached_property
    def lines(self) -> list[str]:
        return self.path.read_text(encoding="utf-8").splitlines()

    @cached_property
    def tree(self) -> ast.Module:
        return ast.parse("\n".join(self.lines))

    @property
    def parts(self) -> list[str]:
        """The components of the name: package, room, …."""
        return self.name.split(".")

    @property
    def room(self) -> str:
        """The folder or module directly in the package, or the package itself."""
        return ".".join(self.parts[:2])

    def at(self, node: ast.expr | ast.stmt) -> str:
        return f"{self.path}:{node.lineno}"


@dataclass(frozen=True)
class House:
    """A package with its templates and its documentation."""

    root: Path
    package: str = "reportgen"

    @cached_property
    def modules(self) -> Mapping[str, Module]:
        found = {}
        for path in sorted((self.root / self.package).rglob("*.py")):
            parts = path.relative_to(self.root).with_suffix("").parts
            name = ".".join(parts[:-1] if parts[-1] == "__init__" else parts)
            found[name] = Module(name, path)
        return found

    @cached_property
    def imports(self) -> Graph:
        """The modules that each module imports, including imports inside functions and for types alone."""
        return {name: frozenset(self._imported(module)) - {name} for name, module in self.modules.items()}

    def _imported(self, module: Module) -> Iterator[str]:
        for node in ast.walk(module.tree):
            names: list[str] = []
            if isinstance(node, ast.Import):
                names = [alias.name for alias in node.names]
            elif isinstance(node, ast.ImportFrom):
                assert not node.level, f"{module.at(node)}: an import says its whole name"
                inner = [f"{node.module}.{alias.name}" for alias in node.names]
                # A name that is not a module itself belongs to the module that it is imported from.
                names = [name if name in self.modules else str(node.module) for name in inner]
            yield from (name for name in names if name in self.modules)

    @cached_property
    def arrows(self) -> Graph:
        """The rooms that each room imports from."""
        rooms = {name: module.room for name, module in self.modules.items()}
        found: dict[str, set[str]] = {room: set() for room in rooms.values()}
        for name, imported in self.imports.items():
            found[rooms[name]] |= {rooms[one] for one in imported} - {rooms[name]}
        return {room: frozenset(others) for room, others in found.items()}

    @cached_property
    def floors(self) -> Mapping[str, int]:
        """The floor of each room, from 1; rooms of one cycle share theirs."""
        floors: dict[str, int] = {}
        for circle in strongly_connected(self.arrows):
            below = {other for room in circle for other in self.arrows[room]} - circle
            floors |= dict.fromkeys(circle, 1 + max((floors[room] for room in below), default=0))
        return floors


def strongly_connected(graph: Graph) -> list[frozenset[str]]:
    """Return the sets of nodes that reach one another, each after all its successors (Tarjan)."""
    found: list[frozenset[str]] = []
    number: dict[str, int] = {}
    lowest: dict[str, int] = {}
    open_nodes: list[str] = []

    def visit(node: str) -> None:
        number[node] = lowest[node] = len(number)
        open_nodes.append(node)
        for other in sorted(graph[node]):
            if other not in number:
                visit(other)
            if other in open_nodes:
                lowest[node] = min(lowest[node], lowest[other])
        if lowest[node] == number[node]:
            start = open_nodes.index(node)
            found.append(frozenset(open_nodes[start:]))
            del open_nodes[start:]

    for node in sorted(graph):
        if node not in number:
            visit(node)
    return found


# --- what is counted --------------------------------------------------------------------------------

Counted = int | Sequence[str]
"""A number, or the list of places that are counted."""


def rooms(house: House) -> Counted:
    return sorted(house.arrows)


def floors(house: House) -> Counted:
    return max(house.floors.values())


def arrows(house: House) -> Counted:
    return [f"{room} → {other}" for room, others in house.arrows.items() for other in sorted(others)]


def arrows_back_up(house: House) -> Counted:
    """Return imports from a room that is not on a lower floor."""
    floor = house.floors
    return [
        f"{room} → {other}" for room, others in house.arrows.items() for other in others if floor[other] >= floor[room]
    ]


def circles(house: House) -> Counted:
    """Return sets of modules that import one another."""
    return [" ↔ ".join(sorted(circle)) for circle in strongly_connected(house.imports) if len(circle) > 1]


def longest_module(house: House) -> Counted:
    return max(len(module.lines) for module in house.modules.values())


def words_of_architecture(house: House) -> Counted:
    return len((house.root / "ARCHITECTURE.md").read_text(encoding="utf-8").split())


def ids_by_f_string(house: House) -> Counted:
    """Return f-strings that begin like the id of a quantity: `f"v.{point}"`."""
    return [
        module.at(node)
        for module in house.modules.values()
        for node in ast.walk(module.tree)
        if isinstance(node, ast.JoinedStr) and len(node.values) > 1
        if isinstance(head := node.values[0], ast.Constant) and _ID.match(str(head.value))
    ]


def class_names_twice(house: House) -> Counted:
    """Return class names with several meanings, except private ones (`_Name`).

    Every kind has its `Parameters`: one meaning, a model each.
    """
    names = Counter(
        node.name
        for module in house.modules.values()
        for node in ast.walk(module.tree)
        if isinstance(node, ast.ClassDef) and not node.name.startswith("_") and node.name != "Parameters"
    )
    return sorted(name for name, count in names.items() if count > 1)


MODELS_OF_KINDS = {"Parameters", "Indicator"}
"""Names that the module of each kind must give to its models, so that the catalogue finds them."""


def type_aliases_twice(house: House) -> Counted:
    """Return names of types (`Row = tuple[str, int]`) that several modules define, except private ones."""
    names = Counter(name for module in house.modules.values() for name in _aliases(module.tree))
    return sorted(name for name, count in names.items() if count > 1 and name not in MODELS_OF_KINDS)


def _aliases(tree: ast.Module) -> set[str]:
    """Return the public names in CamelCase that a module binds to a type expression or to another type name."""
    return {
        name
        for node in tree.body
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name)
        if _CAMEL_CASE.fullmatch(name := node.targets[0].id)
        if isinstance(node.value, ast.Subscript | ast.BinOp | ast.Name | ast.Attribute)
    }


def longest_positional_call(house: House) -> Counted:
    """Return the largest number of positional arguments of a call; a variable-length list counts as one."""
    listing = dict(_listing(house))
    return max(
        min(len(call.args), listing.get(_called(call), len(call.args)))
        for module in house.modules.values()
        for call in ast.walk(module.tree)
        if isinstance(call, ast.Call)
    )


def _listing(house: House) -> Iterator[tuple[str, int]]:
    """Return functions with a variable-length list (`*names`), and the number of arguments up to that list."""
    for module in house.modules.values():
        for node in ast.walk(module.tree):
            if isinstance(node, ast.FunctionDef) and node.args.vararg is not None:
                named = [argument.arg for argument in (*node.args.posonlyargs, *node.args.args)]
                yield node.name, len(named) - (named[:1] in (["self"], ["cls"])) + 1


def _called(call: ast.Call) -> str:
    match call.func:
        case ast.Name(id=name) | ast.Attribute(attr=name):
            return name
    return ""


def topic_names_elsewhere(house: House) -> Counted:
    """Return modules outside the topics that import a topic or name one, as an identifier or in a text without blanks.

    A word of the field that is also the name of a topic is left out: any machine moves.  So are `OFFERED`, the places
    where the program's public interface has such a word.
    """
    topics = {module.parts[1] for module in house.modules.values() if module.parts[2:] == ["topic"]}
    words = topics - {"motion"}
    found = []
    for module in house.modules.values():
        if len(module.parts) > 1 and module.parts[1] in topics:
            continue
        found += [
            f"{module.path} imports {name}"
            for name in sorted(house.imports[module.name])
            if len(name.split(".")) > 1 and name.split(".")[1] in topics
        ]
        named = {name for name in _identifiers(module.tree) if words & set(re.split(r"[^a-z]+", name))}
        found += [f"{module.path} {name}" for name in sorted(named - OFFERED.get(module.name, frozenset()))]
    return found


OFFERED: Mapping[str, frozenset[str]] = {
    # A set of drawing sheets, an option of the command line.
    "reportgen.cli.student": frozenset({"balancing"}),
    # The torque that balances the loads has this name in the results of any machine.
    "reportgen.case.result_entries": frozenset({"balancing_force", "balancing_torque"}),
    "reportgen.results.terminal_tables": frozenset({"balancing_force", "balancing_torque"}),
    # A chapter of the key.
    "reportgen.formula.vocabulary": frozenset({"balancing"}),
}


def _identifiers(tree: ast.Module) -> Iterator[str]:
    """Return names, attributes, parameters, keywords, and texts without blanks that are not docstrings."""
    docstrings = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
    for node in ast.walk(tree):
        match node:
            case ast.Name(id=name) | ast.Attribute(attr=name) | ast.arg(arg=name) | ast.keyword(arg=str(name)):
                yield name
            case ast.FunctionDef(name=name) | ast.ClassDef(name=name):
                yield name
            case ast.Constant(value=str(text)) if " " not in text and id(node) not in docstrings:
                yield text


def vague_names(house: House) -> Counted:
    """Return variables, parameters and attributes with a vague name.

    It may stay in a comprehension or lambda that ends a line further on at most, and `other` in an operator.
    """
    return [
        f"{module.path}:{line} {name}"
        for module in house.modules.values()
        for name, line in _bound(module.tree)
        if name in VAGUE - PUBLIC.get(module.name, set())
    ]


def _bound(node: ast.AST) -> Iterator[tuple[str, int]]:
    """Yield the names bound in a part of a module, with their lines; skip those in short expressions."""
    for inner in ast.iter_child_nodes(node):
        match inner:
            case ast.ListComp() | ast.SetComp() | ast.DictComp() | ast.GeneratorExp() | ast.Lambda():
                if (inner.end_lineno or 0) - inner.lineno <= 1:
                    continue
            case ast.FunctionDef(name=name) if name.startswith("__"):
                yield from (bound for part in inner.body for bound in _bound(part))
                continue
            case ast.FunctionDef(name=name) | ast.ClassDef(name=name) | ast.arg(arg=name):
                yield name, inner.lineno
            case ast.Name(id=name, ctx=ast.Store()) | ast.Attribute(attr=name, ctx=ast.Store()):
                yield name, inner.lineno
            case ast.MatchAs(name=str(name)) | ast.MatchStar(name=str(name)):
                yield name, inner.lineno
        yield from _bound(inner)


LIMITS: Mapping[Callable[[House], Counted], int | None] = {
    rooms: None,
    floors: None,
    arrows: None,
    arrows_back_up: 0,
    circles: 0,
    longest_module: 500,
    words_of_architecture: 1200,
    ids_by_f_string: 0,
    class_names_twice: 0,
    type_aliases_twice: 0,
    topic_names_elsewhere: 0,
    longest_positional_call: 6,
    vague_names: 0,
}
"""Limit of each figure; `None`: printed for information, without a limit."""


def main(root: Path = ROOT) -> int:
    house, passed = House(root), 0
    for counting, limit in LIMITS.items():
        counted = counting(house)
        count, places = (counted, ()) if isinstance(counted, int) else (len(counted), counted)
        bound = "" if limit is None else f"   at most {limit}"
        print(f"{counting.__name__.replace('_', ' '):25}{count:7}{bound}")
        if limit is not None and count > limit:
            passed += 1
            for place in places[:SHOWN]:
                print(f"    {place}")
    return 1 if passed else 0


if __name__ == "__main__":
    sys.exit(main())
