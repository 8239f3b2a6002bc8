"""JSON Schema of assignment files, with units, bounds, defaults, choices, and rules of several keys.

It has a few extensions of the standard, which other readers ignore: `x-unit` and `x-range` of a quantity,
`x-unit-name` of a unit that may be another one like it, `x-same-length` and `x-increasing` of tables.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import cache
from typing import Any

from pydantic import BaseModel, TypeAdapter
from pydantic.json_schema import GenerateJsonSchema, JsonSchemaMode, models_json_schema

from reportgen.assignment.checks import Increasing, OneOf, SameLength
from reportgen.assignment.common import Kind, file_model
from reportgen.base.errors import Where
from reportgen.base.field_words import FieldWords
from reportgen.base.units import Given

Schema = dict[str, Any]

SAME_LENGTH_KEY, INCREASING_KEY = "x-same-length", "x-increasing"
_FORMS = {"object": "table", "array": "list"}


_GENERAL = frozenset({"file", "topic"})
"""Names of modules that several packages have: a definition then includes the name of the package."""


class _Generator(GenerateJsonSchema):
    """The schema of pydantic, with definitions named for readers and defaults as a file would have them."""

    def normalize_name(self, name: str) -> str:
        """Return the name of a definition: `Pin`; if several have that name, with the module, `FourBarParameters`.

        Pydantic asks for the name of a class alone, then with its module, then with an id.
        """
        *modules, model = name.split(".")
        named = modules[-2:] if modules[-1:] and modules[-1] in _GENERAL else modules[-1:]
        title = "".join(word.capitalize() for module in named for word in module.split("_"))
        return title + str(super().normalize_name(model.lstrip("_")))

    def encode_default(self, dft: Any) -> Any:
        if isinstance(dft, Given):
            return dft.text
        if isinstance(dft, tuple):
            return [self.encode_default(part) for part in dft]
        if isinstance(dft, BaseModel):
            return {}
        return super().encode_default(dft)


@cache
def file_schema(kind: Kind) -> Schema:
    """Return the JSON Schema of a whole file of a kind; of draft 2020-12."""
    schema = file_model(kind).model_json_schema(by_alias=True, schema_generator=_Generator)
    _add_checks(schema, schema, kind)
    return schema


@cache
def parameters_schema(kind: Kind) -> Schema:
    """Return the JSON Schema of the section `parameters` of a kind, without its checks; of draft 2020-12."""
    return kind.parameters.model_json_schema(by_alias=True, schema_generator=_Generator)


def schema_of(kinds: Iterable[Kind], words: Callable[[str], Mapping[str, FieldWords]]) -> Schema:
    """Return the JSON Schema (draft-07, which every editor supports) of files of any of the kinds, with their
    labels.
    """
    # All together: models with one name in different kinds get different names.
    models: dict[Kind, tuple[type[BaseModel], JsonSchemaMode]] = {
        kind: (file_model(kind), "validation") for kind in kinds
    }
    references, definitions = models_json_schema([*models.values()], by_alias=True, schema_generator=_Generator)
    modern = {"title": "reportgen assignment", "oneOf": [references[model] for model in models.values()], **definitions}
    for kind, model in models.items():
        _add_checks(references[model], modern, kind)
        _add_words(references[model], modern, words(kind.name), ())
    return {"$schema": "http://json-schema.org/draft-07/schema#", **_as_draft_07(modern)}


def _as_draft_07(part: Any) -> Any:
    """Return a schema of draft 2020-12 converted to draft-07; only one keyword of the models differs."""
    match part:
        case dict():
            return {"definitions" if key == "$defs" else key: _as_draft_07(value) for key, value in part.items()}
        case list():
            return [_as_draft_07(item) for item in part]
        case str():
            return part.replace("#/$defs/", "#/definitions/")
        case _:
            return part


# --- rules of checks, and words of keys -------------------------------------------------------------


def _add_checks(part: Schema, root: Schema, kind: Kind) -> None:
    """Add the rules of a kind's checks about several keys to the schema."""
    for check in kind.all_checks:
        match check:
            case OneOf(names=names, required=required, form=form):
                either = [{"required": [name]} for name in names]
                rule = {"oneOf": either} if required else {"not": {"required": [*names]}}
                for table in tables_at(part, root, check.where):
                    if set(names) & set(table["properties"]) and (form is None or _is_form(table, *form)):
                        _add(table, "allOf", rule)
            case SameLength(key=key, rows=rows):
                for table in tables_at(part, root, tuple(check.section.split("."))):
                    alike = [row for row in (key, *rows) if row in table["properties"]]
                    if len(alike) > 1 and key in alike:
                        _add(table, SAME_LENGTH_KEY, alike)
            case Increasing(key=key, first=first, last=last, unit=unit):
                for table in tables_at(part, root, tuple(check.section.split("."))):
                    if key in table["properties"]:
                        table["properties"][key][INCREASING_KEY] = {"from": first, "to": last, "unit": unit}
            case _:
                pass


def _is_form(table: Schema, key: str, value: str) -> bool:
    return bool(table["properties"].get(key, {}).get("const") == value)


def _add(table: Schema, key: str, rule: Any) -> None:
    """Put something into a list of the schema, once."""
    listed = table.setdefault(key, [])
    if rule not in listed:
        listed.append(rule)


def _add_words(part: Schema, root: Schema, words: Mapping[str, FieldWords], path: tuple[str, ...]) -> None:
    """Label and describe the keys of a schema, and everything in them."""
    for schema in alternatives(part, root):
        for inner in _unnamed(schema):
            _add_words(inner, root, words, path)
        for key, about in schema.get("properties", {}).items():
            said = words.get(".".join((*path, key)))
            # A definition that several kinds share is described in the words of the first.
            if said is not None and "description" not in about:
                about["title"], about["description"] = said.label, said.whole
            _add_words(about, root, words, (*path, key))


def _unnamed(schema: Schema) -> Iterator[Schema]:
    """Yield the schemas of an item of a list, and of any key of a table of names."""
    for inner in (
        schema.get("items"),
        schema.get("additionalProperties"),
        *schema.get("patternProperties", {}).values(),
    ):
        if isinstance(inner, dict):
            yield inner


# --- the schema at a place --------------------------------------------------------------------------


def tables_at(part: Schema, root: Schema, where: Where) -> list[Schema]:
    """Return the tables that are allowed at a place."""
    return [schema for schema in places(part, root, where) if "properties" in schema]


def known_keys(kind: Kind, where: Where) -> list[str]:
    """Return the keys that a table at `where` in a file of a kind may have; an empty list if there is no table."""
    return keys_at(file_schema(kind), where)


def allowed_forms(kind: Kind, where: Where) -> frozenset[str]:
    """Return the forms of content that a file of a kind may have at `where`: "table", "list", "scalar"; empty if
    unknown.
    """
    schema = file_schema(kind)
    forms = [schema.get("type", "string") for schema in places(schema, schema, where)]
    types = [name for type_ in forms for name in (type_ if isinstance(type_, list) else [type_])]
    return frozenset(_FORMS.get(str(name), "scalar") for name in types if name != "null")


def choices_of(schema: Schema) -> list[str]:
    """Return the values allowed by one alternative of the schema."""
    if schema.get("type") == "boolean":
        return ["true", "false"]
    return [str(value) for value in (*schema.get("enum", ()), *([schema["const"]] if "const" in schema else ()))]


def alternatives_to(kind: Kind, path: Sequence[str], values: Mapping[str, str] | None = None) -> list[str]:
    """Return the other keys with the same meaning as the key of a path.

    With the `values` of the table, those of the form that they choose; else those of every form.
    """
    checks = [check for check in kind.all_checks if isinstance(check, OneOf) and check.where == tuple(path[:-1])]
    if values is not None:
        checks = [check for check in checks if check.form is None or values.get(check.form[0]) == check.form[1]]
    return [name for check in checks if path[-1] in check.names for name in check.names if name != path[-1]]


def section_schema(content: Any) -> Schema:
    """Return the JSON Schema of the type of a section's content."""
    return TypeAdapter(content).json_schema(schema_generator=_Generator)


def keys_at(schema: Schema, where: Where) -> list[str]:
    """Return the keys that a JSON Schema allows at a place; for alternatives, all their keys."""
    return list(
        dict.fromkeys(name for schema in places(schema, schema, where) for name in schema.get("properties", {}))
    )


def places(part: Schema, root: Schema, where: Where) -> list[Schema]:
    """Return the alternatives that a part of a JSON Schema allows at a place below it."""
    level = list(alternatives(part, root))
    for step in where:
        inner = [inner for schema in level for inner in _inside(schema, step)]
        level = [alternative for schema in inner for alternative in alternatives(schema, root)]
    return level


def _inside(schema: Schema, step: str | int) -> Iterator[Schema]:
    """Yield the schemas of a key, of an item of a list, or of any key of a table of names."""
    if isinstance(step, int):
        if isinstance(schema.get("items"), dict):
            yield schema["items"]
    elif step in schema.get("properties", {}):
        yield schema["properties"][step]
    elif isinstance(schema.get("additionalProperties"), dict):
        yield schema["additionalProperties"]
    else:
        yield from schema.get("patternProperties", {}).values()


def alternatives(schema: Schema, root: Schema) -> Iterator[Schema]:
    """Yield the alternatives of a JSON Schema, with references followed and `oneOf`, `anyOf` split."""
    if "$ref" in schema:
        yield from alternatives(root["$defs"][schema["$ref"].rsplit("/", 1)[-1]], root)
    elif choices := [*schema.get("oneOf", ()), *schema.get("anyOf", ())]:
        for choice in choices:
            yield from alternatives(choice, root)
    else:
        yield schema
