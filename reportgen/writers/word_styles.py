"""Parts of a Word file that define its look: styles, lists and settings, from `templates/frames/word/`.

A school's own styles take precedence over ours, under the names that the report uses.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from functools import cache
from typing import TYPE_CHECKING, Any
from xml.etree import ElementTree

from reportgen.base.languages import setting_of
from reportgen.base.template_folders import templates
from reportgen.base.units import Language
from reportgen.writers.word_elements import DECLARED, MATH_FONT, NAMESPACES, PROLOGUE, escape, twips

if TYPE_CHECKING:
    from jinja2 import Environment

EQUATION_SIZE, KNOWN_SIZE = 12.0, 9.5
"""Font sizes (points) of displayed formulas, in which their lines are measured, and of known data of vectors below."""
HEADINGS, BULLETS = 1, 2
"""Ids of the lists of headings and of unordered lists; ordered lists follow, one id each."""
LIST_INDENT = 8.0
"""Additional indentation of each level of a list (mm)."""


@cache
def _environment() -> Environment:
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    made = Environment(
        loader=FileSystemLoader(templates() / "frames" / "word"),
        undefined=StrictUndefined,
        # Texts go through `escape`, as in all other parts.
        autoescape=False,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    made.globals |= {"declared": DECLARED, "math_font": MATH_FONT}
    made.filters |= {"escaped": escape, "twips": twips}
    return made


def _part(name: str, **values: Any) -> str:
    """Return a part from its frame, without the white space between elements that keeps the frame readable."""
    text = _environment().get_template(f"{name}.xml.j2").render(values)
    return PROLOGUE + "".join(line.strip() for line in text.splitlines())


def styles(font: str, size: float, language: Language, close: bool, room: float) -> str:
    """Return the part of styles of a report in a font of a size (points), whose text is `room` wide (mm).

    If it is set `close`, font and gaps are smaller. Without a school's own styles, these are all that the report uses.
    """
    body, gap = (size - 1, 4.0) if close else (size, 5.0)
    sizes = {"equation": EQUATION_SIZE, "known": KNOWN_SIZE}
    own = setting_of(language)
    far = own.word.east_asian or font
    look = {"font": font, "east_asian": far, "size": body, "gap": gap, "code": own.code, "room": room}
    return _part("styles", headings=HEADINGS, **look, **sizes)


def numbering(starts: Sequence[tuple[int, int]]) -> str:
    """Return the part of lists; `starts` are level and first number of each ordered one."""
    return _part("numbering", starts=starts, headings=HEADINGS, bullets=BULLETS, indent=LIST_INDENT)


def settings(language: Language) -> str:
    """Return the part of settings: compatibility with Word 2013 and later, the formula font, the language's marks."""
    own = setting_of(language)
    return _part("settings", code=own.code, decimal=own.decimal, separator=own.separator)


def properties(title: str, author: str, language: Language) -> str:
    """Return the part with the file's properties, without a date."""
    return _part("core", title=title, author=author, code=setting_of(language).code)


# --- a school's own styles ---------------------------------------------------------------------------

_W = f"{{{NAMESPACES['w']}}}"
_REFERENCES = frozenset(f"{_W}{name}" for name in ("basedOn", "next", "link"))
_BEFORE_NUMBERS = frozenset(
    f"{_W}{name}" for name in ("pStyle", "keepNext", "keepLines", "pageBreakBefore", "framePr", "widowControl")
)
"""Elements that precede the list of a style in the schema's order."""


def merged(ours: str, school: str, language: Language) -> str:
    """Return a school's styles under the names that the report uses, completed; lists and language stay ours."""
    own, usual = ElementTree.fromstring(school), ElementTree.fromstring(ours)
    styles, wanted = ({_named(style): style for style in one.iter(f"{_W}style")} for one in (own, usual))
    ids = {_id(styles[name]): _id(style) for name, style in wanted.items() if name in styles}
    # The report's own ids are all reserved, because styles that the school lacks are added below.
    taken = {_id(style).casefold() for style in wanted.values()}
    for style in styles.values():
        if _id(style) not in ids:
            ids[_id(style)] = _free(_id(style), taken)
            taken.add(ids[_id(style)].casefold())
    for name, style in styles.items():
        style.set(f"{_W}styleId", ids[_id(style)])
        for reference in (one for one in style if one.tag in _REFERENCES):
            reference.set(f"{_W}val", ids.get(reference.get(f"{_W}val", ""), "Normal"))
        lines = style.find(f"{_W}pPr")
        if lines is not None:
            for numbers in lines.findall(f"{_W}numPr"):
                lines.remove(numbers)
        if name in wanted and (numbers_wanted := wanted[name].find(f"{_W}pPr/{_W}numPr")) is not None:
            _put_in_list(style, numbers_wanted)
    own.extend(style for name, style in wanted.items() if name not in styles)
    letters = own.find(f"{_W}docDefaults/{_W}rPrDefault/{_W}rPr")
    if letters is None:
        for incomplete in own.findall(f"{_W}docDefaults"):
            own.remove(incomplete)
        own[:0] = usual.findall(f"{_W}docDefaults")
    else:
        for language_tag in letters.findall(f"{_W}lang"):
            letters.remove(language_tag)
        tags = (f"{_W}val", f"{_W}eastAsia")
        ElementTree.SubElement(letters, f"{_W}lang", dict.fromkeys(tags, setting_of(language).code))
    ElementTree.register_namespace("w", NAMESPACES["w"])
    return PROLOGUE + ElementTree.tostring(own, encoding="unicode")


def _free(id: str, taken: Collection[str]) -> str:
    """Return the id, or one derived from it that is not taken."""
    while id.casefold() in taken:
        id = f"own-{id}"
    return id


def _put_in_list(style: ElementTree.Element, numbers: ElementTree.Element) -> None:
    """Give a style the list that numbers it, at its place in the schema's order."""
    lines = style.find(f"{_W}pPr")
    if lines is None:
        lines = ElementTree.Element(f"{_W}pPr")
        letters = style.find(f"{_W}rPr")
        style.insert(len(style) if letters is None else list(style).index(letters), lines)
    lines.insert(sum(line.tag in _BEFORE_NUMBERS for line in lines), numbers)


def _id(style: ElementTree.Element) -> str:
    return style.get(f"{_W}styleId", "")


def _named(style: ElementTree.Element) -> str:
    name = style.find(f"{_W}name")
    return "" if name is None else name.get(f"{_W}val", "").casefold()
