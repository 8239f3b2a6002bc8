"""What single chapters name: the lines that they set out, and the keys of the words that fit."""

from __future__ import annotations

import math
import re
import textwrap
from collections.abc import Collection, Iterator, Mapping, Sequence
from itertools import islice
from keyword import iskeyword

import numpy as np

from reportgen.base.errors import NotOfferedError
from reportgen.base.words import word
from reportgen.catalogue.given_loads import ByOrdinates
from reportgen.document import (
    Block,
    Cell,
    Column,
    Inline,
    InlineMath,
    Inlines,
    Listing,
    Paragraph,
    Table,
    Text,
    Value,
    listed,
)
from reportgen.formula import Expression, Number, Symbol, ids, size, vocabulary, walk
from reportgen.formula.plain import python
from reportgen.formula.vocabulary import Chapter, on_plan
from reportgen.machine import DRIVER
from reportgen.machine.laws import FULL_TURN
from reportgen.machine.loads import Applied
from reportgen.report.comments import Peak, each_peak, reaction_ids, slider_rates, turning_rates
from reportgen.report.guide_couples import guide_couples
from reportgen.report.phrases import sign
from reportgen.report.report import Report

UNIFORM = Number(12.0)
"""What m l² of a uniform rod is divided by."""


def variant_words(report: Report) -> str:
    """The variant in a sentence, with words for one that is not numbered."""
    numbered, assigned = report.words["variant_words"]
    return str(numbered).format(variant=report.variant) if report.variant else str(assigned)


def attached(report: Report) -> str:
    """A further sentence on the drawing sheets that are handed in with the report, if there are any."""
    size = report.assignment.report.sheets
    return f" {report.words['attached'].format(size=size)}" if size else ""


def signature(report: Report) -> tuple[Block, ...]:
    """Place, date and name under the foreword; without a name the label stands over a line to sign."""
    student = f"{report.words['cover']['student']}: {report.assignment.report.student.name or '…' * 20}"
    return tuple(Paragraph((Text(line),), "right") for line in (report.place_and_date, student))


def started(report: Report) -> str:
    """The key of the words for where position 1 is: the kind's own place, or a given angle of the crank."""
    return "natural" if report.assignment.positions.start is None else "given"


def begins_at(report: Report) -> str:
    """Where the first position is: at the "dead_centre" of the first slider, or wherever it is "given"."""
    return "dead_centre" if report.machine.sliders and report.machine.sliders[0].phase == 0 else "given"


def has_chosen_scale(report: Report) -> bool:
    """Whether the length scale is chosen, rather than a drawn length."""
    return "scale" in report.ledger


def tabled_forces(report: Report) -> tuple[Applied, ...]:
    """The working forces that are given by a table."""
    forces = (force for force in report.machine.applied if force.name not in report.further)
    return () if "P.given" in report.ledger else tuple(forces)


def diagram_words(report: Report) -> str:
    """The key of the words for the indicator diagram, which may be given by measured heights."""
    return "ordinates" if isinstance(report.assignment.indicator, ByOrdinates) else "indicator"


def gas_forces(report: Report) -> list[str]:
    """The pressure on each piston and the force of the gas."""
    return report.known(id for piston in report.pistons for id in (ids.pressure(piston.link), piston.name))


def without_mass(report: Report) -> list[str]:
    """The links whose mass is not given."""
    links = sorted({1, *(link for group in report.groups for link in (group.i, group.j))})
    return [str(link) for link in links if ids.mass(link) not in report.mass_lines]


def further_loads(report: Report) -> list[str]:
    """The loads that are declared beside those of the kind."""
    return report.known(row.id for row in report.own["declared"])


def topic_loads(report: Report) -> list[str]:
    """Return the loads that topics bring."""
    return report.known(report.machine.beside)


def uniform_rods(report: Report) -> list[str]:
    """The links whose moment of inertia is that of a uniform rod, J = m l²/12, for want of a given one."""
    moments = {
        link: report.ledger[id].definition for link in report.bodies if (id := ids.inertia(link)) in report.ledger
    }
    return [link for link, formula in moments.items() if formula is not None and UNIFORM in walk(formula)]


def driver_joints(report: Report) -> list[str]:
    """The digits of what is read from the driver's force plan: a reaction, of a sliding one its balance too."""
    return ["01", "cb"] if report.machine.span else ["01"]


def driver_reactions(report: Report) -> list[str]:
    return [ids.reaction(digits) for digits in driver_joints(report)]


def mean_lines(report: Report) -> list[str]:
    """The balance over the cycle: its mean, its ends, the power."""
    return ["M.mean", "M.least", "M.greatest", "power"]


def work_lines(report: Report) -> list[str]:
    """The work of the loads over the cycle, and the mean that gives it back."""
    return ["W", "M.energy"]


def crank_lines(report: Report) -> list[str]:
    return [*report.crank_arms, "M.eq"]


def shares_pins(report: Report) -> bool:
    """Whether several groups hang on one pin of the crank."""
    return len(report.joined) > len(report.crank_pins)


def lever_couples(report: Report) -> list[str]:
    """What torques, which have no arm, contribute to the balance by virtual work."""
    return report.known(ids.lever_moment(torque.name) for torque in report.machine.torques)


def inertia_parts(report: Report) -> list[str]:
    """The shares of the links in the reduced moment of inertia, and their sum."""
    return report.known([*(ids.reduced_inertia(link) for link in report.machine.linkage.links), "J.r"])


# --- the page of results at the front of a report, and its list of symbols ------------------------
BESIDE = 2
"""Sets of columns side by side."""
SET = (24.0, 34.0, 22.0)
"""Columns of one set (mm): the quantity, its greatest value, the positions."""
EXAMPLES = 3
"""Symbols of one kind that stand for all of it."""
MOST_PLACES = 12
"""Letters that a list of positions may have in its column."""

# --- the page of results


def extremes(report: Report, key: str, caption: str, head: Sequence[str]) -> Table:
    """The greatest sizes of velocities, accelerations and reactions with their positions, in sets side by side."""
    peaks = list(_extremes(report))
    height = -(-len(peaks) // BESIDE)
    cells = [tuple(Cell(part) for part in _row(peak)) for peak in peaks]
    cells += [(Cell(),) * len(SET)] * (BESIDE * height - len(cells))
    body = (tuple(cell for line in cells[start::height] for cell in line) for start in range(height))
    titles = tuple(Cell((Text(title),)) for title in head) * BESIDE
    return Table(tuple(map(Column, SET)) * BESIDE, (titles,), tuple(body), report.prose.inlines(caption), key)


def _extremes(report: Report) -> Iterator[Peak]:
    """Of points in translation, else of all that a plan seeks; then of links, then of joints."""
    for what, rotation in (("v", "omega"), ("a", "eps")):
        points = slider_rates(report, what) or report.known(ids.POINT_RATE[what](group.M) for group in report.groups)
        yield from each_peak(report, [*points, *turning_rates(report, rotation)], report.positions)
    couples = [slide.moment for slide in guide_couples(report)]
    yield from each_peak(report, [*reaction_ids(report), *couples], report.all_positions)


def _row(top: Peak) -> tuple[Inlines, Inlines, Inlines]:
    places = top.at if len(top.at) <= MOST_PLACES else f"{top.at.split(',')[0]}, …"
    return top.symbols, (top.value,), (Text(places),)


def main_figures(report: Report) -> Iterator[Sequence[object]]:
    """The scales, how far the balancing torque goes, its mean and power, the flywheel: words, symbol, value, place."""
    for figure, name in report.words["main_figures"].items():
        if id := of_kind(report, figure):
            yield *_figure(report, id, name), extreme_place(report, id)


def _figure(report: Report, id: str, name: str | Mapping[str, str]) -> tuple[str, Expression, Value]:
    """Words, symbol and value; an extreme of the balance is called by its sense, and its size is shown."""
    symbol, sense = report.ledger.symbol(id), sign(report, id)
    if isinstance(name, str):
        return name, symbol, Value(report.ledger.number(id))
    return name[sense], size(symbol) if sense == "negative" else symbol, Value(report.ledger.number(id, size=True))


def of_kind(report: Report, name: str) -> str:
    """The id of a quantity that is named so, or with its kind as in `M.eq:torque`; "" for one that is not there."""
    return next((id for id, one in report.ledger.families.items() if name in (id, f"{id}:{one.kind}")), "")


def extreme_place(report: Report, id: str) -> Inlines:
    """Where over the cycle `M.least` or `M.greatest` is: the crank's turn from position 1, a sliding driver's way."""
    if id not in ("M.least", "M.greatest"):
        return ()
    (low, _), (high, _) = report.analysis.summary.extremes
    angle, span = low if id == "M.least" else high, report.machine.span
    if span:
        return InlineMath(Symbol("s")), Text(" = "), Value(Number(angle / (2 * math.pi) * span * 1e3, 1, "mm"))
    return InlineMath(Symbol("φ")), Text(" = "), Value(Number(math.degrees(angle), 1, "°"))


# --- the list of symbols


def symbols(report: Report) -> Iterator[Sequence[object]]:
    """The kinds of quantities that this report has: some of their symbols, the meaning, the unit."""
    for name, alike in symbol_kinds(report).items():
        shown = tuple(dict.fromkeys(report.ledger.symbol(id) for id in alike))
        units = dict.fromkeys(_unit(report, id) for id in alike)
        yield _some(shown), name, ", ".join(unit or "–" for unit in units)


def _unit(report: Report, id: str) -> str:
    unit = report.ledger[id].how.unit
    return report.ledger.units.get(unit, unit)


def _some(shown: Sequence[Symbol]) -> Inlines:
    first: list[Inline] = [InlineMath(one) for one in shown[:EXAMPLES]]
    return listed([*first, Text("…")] if len(shown) > EXAMPLES else first)


def symbol_kinds(report: Report) -> Mapping[str, list[str]]:
    """The ids of the report's quantities under the meaning that `words.yaml` gives to their kind.

    A quantity that no kind fits is explained where it stands.
    """
    meanings: Mapping[str, str] = report.words["meanings"]
    kinds: dict[str, list[str]] = {name: [] for name in meanings.values()}
    used = report.used_symbols
    for id, family in report.ledger.families.items():
        if not (family.hidden or family.is_plane) and (used is None or family.symbol in used):
            for name in islice(vocabulary.words_of(meanings, id, family.kind, family.symbol), 1):
                kinds[name].append(id)
    return {name: alike for name, alike in kinds.items() if alike}


def images(report: Report) -> Inlines:
    """The images of the crank pin on the plans, for the conventions: a and a′."""
    pin = report.driver.pin
    return listed([InlineMath(on_plan(pin)), InlineMath(on_plan(pin, prime=True))])


def theory_of(report: Report, what: str) -> list[str]:
    """The parts of the theory that the plans of velocities ("v") or accelerations ("a") of this report stand on."""
    points = [place for place in report.machine.linkage.points if place.link != DRIVER]
    if what == "v":
        return report.parts("theory-two-equations") if any(abs(place.local.imag) > 0 for place in points) else []
    inclined = ["theory-inclination"] if report.has_turning_links else []
    similar = ["theory-similarity"] if any(group.similar("a") for group in report.groups) else []
    return report.parts(*inclined, *similar)


# --- a program of the closed formulas -----------------------------------------------------------------

KINDS_SI = {
    "angle": "rad",
    "diameter": "m",
    "area": "m2",
    "speed of rotation": "rpm",
    "length": "m",
    "velocity": "m/s",
    "acceleration": "m/s2",
    "angular velocity": "rad/s",
    "angular acceleration": "rad/s2",
    "weight": "N",
    "force": "N",
    "mass": "kg",
    "moment of inertia": "kg m2",
    "torque": "N m",
    "gravity": "m/s2",
}
"""SI units in letters that every keyboard has."""
LONGEST = 100
"""Characters that a line of the program has room for."""
TABULATED = """names = list(table)
for first in range(0, len(names), 4):
    shown = names[first:first + 4]
    print("position " + " ".join(f"{name:>23}" for name in shown))
    for k in range(N):
        print(f"{k + 1:8d} " + " ".join(f"{table[name][k]:23.15e}" for name in shown))"""

DRAWN = """import sys
import matplotlib
if "--show" not in sys.argv:
    matplotlib.use("agg")
from matplotlib import pyplot as plt
figure, axes = plt.subplots(len(curves), sharex=True, figsize=(7, 2.4 * len(curves)), squeeze=False,
    layout="constrained")
for ax, (unit, names) in zip(axes.flat, curves.items()):
    for name in names:
        ax.plot(driver, table[name], ".-", label=name)
    ax.set_ylabel(unit)
    ax.grid()
    ax.legend()
axes[-1, 0].set_xlabel(DRIVER)
figure.savefig("curves.png", dpi=150)
if "--show" in sys.argv:
    plt.show()"""
CURVES = ("s", "v", "a", "M"), ("x", "y", "v", "a", "M"), ("ω", "ε")
"""Letters of what is drawn: the first of these sets that begins with a letter which the formulas give."""


def program(report: Report) -> Listing:
    """The closed formulas as a program of its own: given data, the formulas in their order, a table of all they give.

    It ends with their curves over the way of the driver.  Its quantities are in SI units and rad, none is rounded.
    What no formula gives stands with its values.  Raises `NotOfferedError` for a machine without closed formulas.
    """
    ledger, kind = report.case.ledger, report.assignment.kind
    changing = [id for id, one in ledger.families.items() if one.chapter is Chapter.formulas and len(one.values) > 1]
    changing_lines = [id for id in changing if ledger[id].definition is not None and not ledger[id].hidden]
    if not changing_lines:
        raise NotOfferedError(word("no_listing", report.assignment.language, kind=kind))
    needed = {other for id in changing_lines for other in (id, *ledger.ancestors(id))}
    data: list[str] = []
    formulas: list[str] = []
    names: dict[str, str] = {}
    for id, family in ledger.families.items():
        if id not in needed:
            continue
        names[id] = name = _python_name(id, names.values())
        note = f"  {_comment(', '.join(filter(None, (KINDS_SI.get(family.kind, ''), report.given_names.get(id, '')))))}"
        try:
            assert family.definition is not None
            formulas += _assigned(name, python(family.definition, names), note)
        except (AssertionError, KeyError):
            data += _assigned(name, _given(family.values, report.machine.count), note)
    table = textwrap.wrap(", ".join(f"{names[id]}={names[id]}" for id in changing_lines), LONGEST - 4)
    title, given, worked, shown, drawn = report.words["listing"]
    return Listing(
        (
            _comment(title.format(machine=report.case.title, id=report.assignment.id)),
            "import numpy as np",
            "",
            f"N = {report.cycle_count}",
            _comment(given),
            *data,
            _comment(worked),
            *formulas,
            _comment(shown),
            "table = dict(",
            *(f"    {line}" for line in table),
            ")",
            *TABULATED.splitlines(),
            _comment(drawn),
            *_curves(report, {id: names[id] for id in changing_lines}),
            *DRAWN.splitlines(),
        )
    )


def _curves(report: Report, names: Mapping[str, str]) -> Iterator[str]:
    """What the curves of a program are drawn over, and which they are, by their units."""
    ledger, machine = report.case.ledger, report.machine
    bases = {id: ledger.symbol(id).base for id in names}
    letters = next((one for one in CURVES if one[0] in bases.values()), CURVES[-1])
    # What slides is told by its displacement; v and a of other points only lead to its own.
    points = {ledger.symbol(id).sub for id in names if bases[id] == letters[0]}
    own = {letter for letter in letters if any(bases[id] == letter and ledger.symbol(id).sub in points for id in names)}
    by_unit: dict[str, list[str]] = {}
    for letter in letters:
        for id, name in names.items():
            if bases[id] == letter and (letter not in own or ledger.symbol(id).sub in points):
                by_unit.setdefault(KINDS_SI.get(ledger[id].kind, ""), []).append(name)
    gone = machine.cycle_angles * (machine.span / FULL_TURN if machine.span else math.degrees(1.0))
    step = float(f"{gone[1]:.12g}")
    even = step * np.arange(len(gone))
    law = f"{step!r} * np.arange(N)" if np.allclose(gone, even, rtol=1e-12) else _given(gone, len(gone))
    yield from _assigned("driver", law, "")
    yield f"DRIVER = {'s (m)' if machine.span else 'phi (deg)'!r}"
    yield from _assigned("curves", repr(by_unit), "")


def _comment(text: str) -> str:
    """Words of others as a comment, which ends with its line: none of them is run."""
    return f"# {' '.join(text.splitlines())}"


def _python_name(id: str, taken: Collection[str]) -> str:
    """A quantity's name in Python, by its id: f.omega.3 is omega_3."""
    plain = re.sub(r"[^0-9A-Za-z]+", "_", id.removeprefix("f.")).strip("_")
    name = f"{plain}_" if iskeyword(plain) or plain in ("N", "np") else plain
    return name if name not in taken else _python_name(f"{id}.f", taken)


def _given(values: np.ndarray, count: int) -> str:
    """Values as they stand; angles that go round evenly by their law."""
    if len(values) == 1:
        return repr(float(values[0].real))
    for turn in (1, -1):
        even = values[0] + turn * np.arange(len(values)) * (FULL_TURN / count)
        if np.allclose(np.exp(1j * even), np.exp(1j * values), rtol=0, atol=1e-12):
            sign = "+" if turn > 0 else "-"
            return f"np.mod({float(values[0])!r} {sign} 2 * np.pi / {count} * np.arange(N), 2 * np.pi)"
    return f"np.array([{', '.join(repr(float(value)) for value in values.real)}])"


def _assigned(name: str, formula: str, note: str) -> list[str]:
    """A line `name = formula  # note`, broken where it is too long."""
    line = f"{name} = {formula}"
    if len(line) <= LONGEST:
        return [line + note if len(line + note) <= LONGEST else line]
    parts = textwrap.wrap(formula, LONGEST - 4, break_long_words=False, break_on_hyphens=False)
    return [f"{name} = ({note}", *(f"    {part}" for part in parts), ")"]
