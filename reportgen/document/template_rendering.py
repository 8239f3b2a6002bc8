"""Render templates, plain Markdown with Jinja names, as blocks of the tree.

The text of a template's author and the values inserted into it never mix. Static text is enclosed in marks that also
carry its file and line; whatever `{{ … }}` emits goes to a side list and leaves a token behind. Both survive macros,
`{% set %}` blocks, `~` and filters: a string made from them still says which part came from where, and all the rest is
a user's text. The marks contain a number that each process draws at random, so that no text can imitate them; it never
reaches the result.
"""

from __future__ import annotations

import re
import traceback
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from contextvars import ContextVar
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from pickle import UnpicklingError
from typing import Any

from jinja2 import (
    BaseLoader,
    BytecodeCache,
    Environment,
    StrictUndefined,
    TemplateNotFound,
    TemplateSyntaxError,
    Undefined,
)
from jinja2.bccache import Bucket
from jinja2.exceptions import SecurityError
from jinja2.ext import Extension
from jinja2.lexer import Token as Sign
from jinja2.lexer import TokenStream
from jinja2.runtime import Context
from jinja2.utils import pass_context

from reportgen.base.errors import ReportgenError, TemplateError
from reportgen.base.files import keep, kept
from reportgen.base.process_limits import TEMPLATES, LimitError, is_bounded
from reportgen.base.records import asdict, replace
from reportgen.base.template_access import template_members
from reportgen.base.template_access import text as as_text
from reportgen.base.template_folders import DEFAULT_LANGUAGE
from reportgen.base.units import MINUS, Language
from reportgen.base.words import find, homes, of_file, refuse_strangers, word
from reportgen.base.yaml_source import STRANGE
from reportgen.document import (
    BlankLine,
    Block,
    InlineMath,
    Inlines,
    Reference,
    Section,
    Text,
    Value,
    markdown,
    template_language,
)
from reportgen.document.markdown import SECRET, Emitted, Rendered, SectionKey, TemplateLine, Unnumbered
from reportgen.document.template_language import (
    LONGEST,
    MOST_ITEMS,
    MOST_STEPS,
    Dialect,
    TooMuchError,
    UnknownSignError,
    numbers,
    short,
)
from reportgen.document.template_values import PLAIN, FunctionToken, Marked, Token, Values, held
from reportgen.formula import Expression, Number, vocabulary

_PIECE = re.compile(
    f"\ue000{SECRET}:(?P<value>\\d+)\ue001"
    f"|\ue002{SECRET}:(?P<line>\\d+):(?P<file>[^\ue003]*)\ue003(?P<static>[^\ue004]*)\ue004"
)


NUMBER = b"271828182845904523"
"""Number in the marks of a kept template; as long as that of a process."""


_values: ContextVar[list[Emitted]] = ContextVar("values")
"""Values that the templates being rendered have emitted so far."""


LONGEST_SECTION = 4_000_000
"""Characters of a section; one with 360 positions worked out has a quarter of them."""
MARKS = 8
"""So many times as long a text may be with its marks, of which a short piece has more than words."""
LONGEST_TOLD = 200
"""Largest number of characters of an error message that are printed."""
ENVIRONMENTS = 8
"""Number of search paths (language, kind, school) whose compiled templates are kept."""


@template_members("__str__")
class NamedPoint(str):
    """The name of a point, which templates print as its symbol."""


class Prose:
    """Renders the sections found in `places`; one object serves a whole report.

    Every section may call `ref(key, …)`, `key(name)` and `unnumbered()` (at the end of a heading),
    `blank(label)`, and `inlines(words)` for the result of a macro or a `{% set %}` block. Raises `TemplateError`
    for a section of a school that would never be read.
    """

    def __init__(self, places: tuple[Path, ...]) -> None:
        refuse_strangers(places)
        self.places = places
        self.values = Values()

    def render(self, name: str, names: Mapping[str, object]) -> tuple[Block, ...]:
        """Return the blocks of the section `name` ("foreword") with `names` filled in.

        Strings appear as they are, expressions as formulas, numbers with their unit, inlines and blocks as themselves,
        sequences item by item. Raise `TemplateError` (`file:line: message`) on any fault.
        """
        outer, steps = held.set(self.values), self.values.steps
        self.values.steps = 0
        try:
            blocks = markdown.blocks(_render(self.places, name, self.values.names({**GLOBALS, **names})))
        finally:
            held.reset(outer)
            self.values.steps = steps
        first = blocks[0] if blocks else None
        return (replace(first, opens=name), *blocks[1:]) if isinstance(first, Section) else blocks

    def inlines(self, words: str) -> Inlines:
        """Return the result of a macro, `caller()` or a `{% set %}` block as inlines, for example a caption.

        This is for functions that a template calls while it is rendered; a plain string becomes plain text.
        """
        return inlines_of(words)


def inlines_of(words: Marked) -> Inlines:
    """Return marked words as inlines, like `Prose.inlines`."""
    return markdown.inlines(_excerpt(words))


class _Compiled(BytecodeCache):
    """Compiled templates by file and content, in this process and in the cache for later ones.

    The number in the marks differs from process to process; cached code has `NUMBER` in its place.
    """

    def __init__(self) -> None:
        self.codes: dict[str, bytes] = {}

    def load_bytecode(self, bucket: Bucket) -> None:
        code = self.codes.get(bucket.key)
        if code is None and (bytecode := kept(self._kept_as(bucket))) is not None:
            code = self.codes[bucket.key] = bytecode.replace(NUMBER, SECRET.encode())
        if code is not None:
            # A damaged file is as good as none.
            with suppress(EOFError, ValueError, TypeError, UnpicklingError):
                bucket.bytecode_from_string(code)

    def dump_bytecode(self, bucket: Bucket) -> None:
        code = self.codes[bucket.key] = bucket.bytecode_to_string()
        if NUMBER not in code:  # the number in the text of a template is not a mark
            keep(self._kept_as(bucket), code.replace(SECRET.encode(), NUMBER))

    def _kept_as(self, bucket: Bucket) -> str:
        # The code that a template becomes depends on what these modules do with it.
        changed = max(Path(file).stat().st_mtime_ns for file in (__file__, template_language.__file__))
        return f"template-{changed:x}-{bucket.key}"


_compiled = _Compiled()


class _Sections(BaseLoader):
    """Loader of sections as templates whose lines have the numbers that they have in their file."""

    def __init__(self, places: tuple[Path, ...]) -> None:
        self.places = places

    def get_source(self, environment: Environment, template: str) -> tuple[str, str, Callable[[], bool]]:
        passage = find(template, self.places)
        if passage is None:
            raise TemplateNotFound(template)
        above = "{#" + "\n" * (passage.line - 1) + "#}\n"  # a comment, of which nothing is left
        return above + passage.text, str(passage.file), lambda: find(template, self.places) == passage


@lru_cache(maxsize=ENVIRONMENTS)
def _environment(places: tuple[Path, ...]) -> Dialect:
    """Return the environment of some places with its compiled sections; a changed section is read again."""
    return Dialect(
        {"join": _join},
        loader=_Sections(places),
        bytecode_cache=_compiled,
        extensions=[_Provenance],
        undefined=StrictUndefined,
        finalize=_finalize,
        autoescape=False,
        auto_reload=True,
        optimized=False,  # constants are too few here for folding them to pay
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )


def _render(places: tuple[Path, ...], name: str, names: Mapping[str, object]) -> Rendered:
    """Return the section `name` with `names` filled in; raise `TemplateError` with file and line on any fault."""
    values: list[Emitted] = []
    outer = _values.set(values)
    try:
        output = _within(_environment(places).get_template(name).generate(names))
    except TemplateNotFound as error:
        file, line = _origin(error, places, name)
        raise TemplateError(f"{file}:{line}: there is no section {error.name}") from error
    except ReportgenError:
        raise
    except Exception as error:
        # Outside the process with limits it is the computer that has too little memory.
        if isinstance(error, MemoryError) and not is_bounded():
            raise
        file, line = _origin(error, places, name)
        raise TemplateError(f"{file}:{line}: {_reason(error, places)}") from error
    finally:
        _values.reset(outer)
    return _assemble(output, name, values, places)


def _within(pieces: Iterable[str]) -> str:
    """Return the pieces of a section joined, up to the piece that exceeds a limit."""
    rendered, size = [], 0
    for piece in pieces:
        rendered.append(piece)
        size += len(piece)
        if size > MARKS * LONGEST_SECTION:
            break
    return "".join(rendered)


def _reason(error: Exception, places: tuple[Path, ...]) -> str:
    match error:
        case TemplateSyntaxError() if not isinstance(error, UnknownSignError):
            return error.message or type(error).__name__
        case SecurityError() | UnknownSignError():
            return word("template_unsafe", _language(places))
        case RecursionError() | SyntaxError():  # Python has a similar limit of nesting
            return word("template_depth", _language(places))
        case TooMuchError():
            return _too_much(places)
        case MemoryError() | LimitError():
            return word("template_limits", _language(places), **asdict(TEMPLATES))
    # Any other argument of an error may be a value of the program.
    reason = str(error) if all(type(one) in PLAIN for one in error.args) else ""
    return f"{type(error).__name__}: {reason[:LONGEST_TOLD]}"


def _too_much(places: tuple[Path, ...]) -> str:
    bounds = {"text": LONGEST, "section": LONGEST_SECTION, "items": MOST_ITEMS, "steps": MOST_STEPS}
    return word("template_long", _language(places), **bounds)


def _language(places: tuple[Path, ...]) -> Language:
    return of_file(places[-1]) if places else DEFAULT_LANGUAGE


def _excerpt(fragment: str) -> Rendered:
    """Return a string made in the template (by a macro, `caller()` or `{% set %}`), ready to be parsed.

    Plain text in it stays text. Outside a rendering, every string is plain text.
    """
    outer = _values.set(_values.get([]))
    try:
        return _assemble(_emit(fragment), "", _values.get(), ())
    finally:
        _values.reset(outer)


# --- values that a template may emit --------------------------------------------------------------


@pass_context  # keeps Jinja from folding constants, which would fill the side list while compiling
def _finalize(context: Context, value: object) -> str:
    return _emit(value)


def _emit(value: object) -> str:
    """Return the text that represents a value in the Markdown; raise `TypeError` for a value without one."""
    match value:
        case FunctionToken():
            raise TypeError("a function has no place in words")
        case Token():
            return _emit(held.get().own(value))
        case Undefined():
            return str(value)  # raises, naming what is undefined
        case NamedPoint():
            return _store(InlineMath(vocabulary.point(value)))
        case str():
            return _emit_text(value)
        case bool() | float() | None:
            raise TypeError(f"{value!r} has no place in words; a number needs its decimals")
        case int():
            return _store(Text(str(value).replace("-", MINUS)))
        case Number():
            return _store(Value(value))
    if isinstance(value, Expression):
        return _store(InlineMath(value))
    if isinstance(value, Emitted):
        return _store(value)
    if isinstance(value, Iterable) and not isinstance(value, Mapping):
        return "".join(map(_emit, value))
    raise TypeError(f"a {type(value).__name__} has no place in words")


def _emit_text(text: str) -> str:
    """Return a string with its marked parts unchanged and everything between them as plain text."""
    if len(text) > MARKS * LONGEST:
        raise TooMuchError
    result, end = [], 0
    for piece in _PIECE.finditer(text):
        result += [_store_text(text[end : piece.start()]), piece.group()]
        end = piece.end()
    return "".join([*result, _store_text(text[end:])])


def _store_text(text: str) -> str:
    if SECRET in text:
        raise ValueError("a filter has cut a piece of the template in two")
    return _store(Text(short(text))) if text else ""


def _store(value: Emitted) -> str:
    values = _values.get()
    values.append(value)
    return f"\ue000{SECRET}:{len(values) - 1}\ue001"


def _join(values: object, separator: str = "") -> str:
    """Return strings joined to a string; anything else becomes a sequence with the same separator."""
    parts = [held.get().own(part) for part in held.get().items(values)]
    if all(isinstance(part, (str, int)) for part in parts):
        return short(separator.join(map(str, parts)))
    return _emit(separator).join(map(_emit, parts))


def _ref(*key: object) -> Reference:
    """Return a reference to a key; the parts of the key are joined with dots."""
    return Reference(".".join(_plain(as_text(part)) for part in key))


def _key(name: str) -> SectionKey:
    return SectionKey(_plain(name))


def _blank(label: str = "") -> BlankLine:
    return BlankLine(_plain(label))


def _plain(text: str) -> str:
    if not isinstance(text, str) or SECRET in text:
        raise TypeError("a plain string is wanted here")
    return text


GLOBALS: Mapping[str, Callable[..., Any]] = {
    "ref": _ref,
    "key": _key,
    "unnumbered": Unnumbered,
    "blank": _blank,
    "inlines": inlines_of,
    "range": numbers,
}
"""The functions that every template may call."""


# --- where things come from -----------------------------------------------------------------------


_WHITE = {ord(letter): " " for letter in "\n\t"}
_MATH = re.compile(r"\$([^\W\d_][\w.]*)\$")
# A Chinese letter ends a key, because Chinese has no blank after it.
_REFERENCE = re.compile(r"@((?:eq|fig|tab)(?:\.[^\W\u2e80-\U0010ffff]+)+)")


class _Provenance(Extension):
    """Encloses static text in its marks, and marks the line of every `{{`.

    Before that `$x$` becomes `{{ math("x") }}`, and `@fig.a` becomes `{{ ref("fig.a") }}`.
    """

    def preprocess(self, source: str, name: str | None, filename: str | None = None) -> str:
        return _REFERENCE.sub(r'{{ ref("\1") }}', _MATH.sub(r'{{ math("\1") }}', source))

    def filter_stream(self, stream: TokenStream) -> Iterator[Sign]:
        file = stream.filename or stream.name or ""
        for token in stream:
            if token.type in ("data", "string"):
                flat = token.value.translate(_WHITE) if token.type == "data" else token.value
                if strange := STRANGE.search(flat):
                    line = token.lineno + token.value.count("\n", 0, strange.start())
                    refusal = word("template_character", of_file(Path(file)))
                    raise TemplateSyntaxError(refusal, line, stream.name, file)
            if token.type == "data":
                yield _static(token.lineno, file, token.value)
            else:
                if token.type == "variable_begin":
                    yield _static(token.lineno, file, "")
                yield token


def _static(line: int, file: str, text: str) -> Sign:
    return Sign(line, "data", f"\ue002{SECRET}:{line}:{file}\ue003{text}\ue004")


@dataclass(slots=True)
class _Lines:
    """The text so far and the origin of each of its lines."""

    text: list[str] = field(default_factory=list)
    lines: list[TemplateLine] = field(default_factory=list)
    fresh: bool = True

    def add(self, static: str, file: str, line: int) -> None:
        if self.fresh:
            self.lines[-1:] = [(file, line)]
        count = static.count("\n")
        self.lines += [(file, line + 1 + i) for i in range(count)]
        if static:
            self.fresh = static.endswith("\n")
        self.text.append(static)


def _assemble(output: str, name: str, values: Sequence[Emitted], search: tuple[Path, ...]) -> Rendered:
    """Return the output without the marks of static text, and the origin of every line and token.

    Raise `TemplateError` for a text that a filter has cut, and for one that is too long.
    """
    so_far, places = _Lines(lines=[(name, 1)]), {}
    place, end = (name, 1), 0
    left = LONGEST_SECTION if len(output) <= MARKS * LONGEST_SECTION else 0
    for piece in _PIECE.finditer(output):
        if piece.start() != end:
            break
        end = piece.end()
        if piece["value"]:
            places[int(piece["value"])] = place
            so_far.text.append(piece.group())
            so_far.fresh = False
            value = values[int(piece["value"])]
            left -= len(value.text) if isinstance(value, Text) else 1
        else:
            line, static = int(piece["line"]), piece["static"]
            so_far.add(static, piece["file"], line)
            place = piece["file"], line + static.count("\n")
            left -= len(static)
        if left < 0:
            raise TemplateError(f"{place[0]}:{place[1]}: {_too_much(search)}")
    if end != len(output):
        raise TemplateError(f"{place[0]}:{place[1]}: a filter has cut a piece of the template in two")
    return Rendered("".join(so_far.text), values, places, so_far.lines)


def _origin(error: Exception, search: tuple[Path, ...], name: str) -> TemplateLine:
    """Return the innermost line of a template that an exception passed through, from Jinja's entries in the traceback.

    For a template that could not be parsed, return its own line; for a missing one, the place where it would be.
    """
    frames = traceback.extract_tb(error.__traceback__)
    places = [(frame.filename, frame.lineno or 1) for frame in frames if frame.filename.endswith(".md")]
    if isinstance(error, TemplateSyntaxError):
        return error.filename or name, error.lineno
    if places:
        return places[-1]
    if (passage := find(name, search)) is not None:
        return str(passage.file), passage.line
    own = next(place for place in search if place.is_relative_to(search[-1]))  # of the machine, if it has one
    return str(next(homes(name, own))[0]), 1


def subscripted(text: str) -> str:
    """Return a point's name with its digits as subscripts: O1A → O₁A."""
    return text.translate(str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉"))
