"""Give each letter one meaning: a symbol of a part that an earlier part uses for something else gets an index.

A part's documents, key, animation and drawing sheets are trees of records that use the same type of symbol, so
`relettered` works for all of them.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping
from typing import Any, TypeVar, cast

from reportgen.base.records import field_names, replace
from reportgen.drawing import Content, Scene
from reportgen.drawing.label_replacement import respelled
from reportgen.formula import Symbol

Tree = TypeVar("Tree")
Letters = Mapping[Symbol, Symbol]
"""Replacements of some symbols."""


def changed(tree: Tree, kind: type | tuple[type, ...], change: Callable[[Any], Any]) -> Tree:
    """Return a tree of records, dataclasses, tuples and mappings with `change` applied to each node of a kind.

    Subtrees without such a node stay the same objects.
    """
    renamed: Tree = _changed(tree, kind, change)
    return renamed


def _changed(node: Any, kind: type | tuple[type, ...], change: Callable[[Any], Any]) -> Any:
    if isinstance(node, kind):
        return change(node)
    if isinstance(node, (tuple, list)):
        items = [_changed(item, kind, change) for item in node]
        same = all(new is old for new, old in zip(items, node, strict=True))
        # A named tuple takes its items as separate arguments.
        return node if same else type(node)(*items) if hasattr(node, "_fields") else type(node)(items)
    if isinstance(node, dict):
        table = {key: _changed(value, kind, change) for key, value in node.items()}
        return table if any(table[key] is not node[key] for key in node) else node
    held = ((name, getattr(node, name)) for name in field_names(type(node)))
    changed_fields = {name: new for name, old in held if (new := _changed(old, kind, change)) is not old}
    return replace(node, **changed_fields) if changed_fields else node


def nodes(tree: Any, kind: type) -> Iterator[Any]:
    """Yield all nodes of a kind in a tree."""
    if isinstance(tree, kind):
        yield tree
    elif isinstance(tree, (tuple, list)):
        for item in tree:
            yield from nodes(item, kind)
    elif isinstance(tree, dict):
        yield from nodes(tuple(tree.values()), kind)
    else:
        for name in field_names(type(tree)):
            yield from nodes(getattr(tree, name), kind)


def relettered(tree: Tree, letters: Letters) -> Tree:
    """Return a tree with some symbols replaced; drawings make room for the new ones."""
    if not letters:
        return tree

    def renamed(tree: Any) -> Any:
        return changed(tree, Symbol, lambda symbol: letters.get(symbol, symbol))

    def spelled(content: Content) -> Content:
        return cast(Content, renamed(content))

    def respelled_or_renamed(node: Scene | Symbol) -> Scene | Symbol:
        if isinstance(node, Symbol):
            return letters.get(node, node)
        return replace(respelled(node, spelled), diagram=renamed(node.diagram), description=renamed(node.description))

    return changed(tree, (Scene, Symbol), respelled_or_renamed)


def with_index(symbol: Symbol, index: str) -> Symbol:
    """Return a symbol with one more index: n → n_cam, Φ_x → Φ_x,cam."""
    return replace(symbol, sub=f"{symbol.sub},{index}" if symbol.sub else index)


def letters_of(quantities: Collection[Symbol], taken: Collection[Symbol], index: str) -> Letters:
    """Return replacements for the symbols of a part's quantities that are `taken`: the same symbols with the part's
    index.
    """
    clash = {quantity for quantity in quantities if quantity in taken and quantity.value is None}
    # s′ is the derivative of s and gets the same index.
    derived = {quantity for quantity in quantities if replace(quantity, base=quantity.base.rstrip("′")) in clash}
    return {quantity: with_index(quantity, index) for quantity in quantities if quantity in clash | derived}
