"""Wide sliders in a report: views for templates, states, table and reactions in figures."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from reportgen.base.records import Record
from reportgen.base.template_access import view
from reportgen.document.template_rendering import NamedPoint
from reportgen.formula import ids
from reportgen.machine.loads import carriers
from reportgen.report.context import ReportContext
from reportgen.report.quantity_tables import RowTable, bare
from reportgen.report.slider_faces import tilts, wide_sliders_of
from reportgen.report.topic_views import ViewHooks, always


@view("lines", "ends")
class WideSlider(Record):
    """A slider with its face: its reaction's `digits`, its pin, the ids of the face's given ends.

    `lines` are the ids of the reaction and of its place, `ends` those of the reactions at both ends of a slider that
    tilts.
    """

    link: int
    digits: str
    pin: NamedPoint
    first: str
    last: str
    below: str

    def __str__(self) -> str:
        return self.digits

    @property
    def lines(self) -> list[str]:
        return [ids.normal_reaction(self.digits), ids.normal_place(self.digits)]

    @property
    def ends(self) -> list[str]:
        return [ids.face_reaction(self.digits, number) for number in (1, 2)]


def wide_sliders(report: ReportContext) -> tuple[WideSlider, ...]:
    """Return the sliders whose faces are given, in the order of the file."""
    linkage, sliders = report.machine.linkage, []
    pins = {link: dyad.middle for dyad in linkage.dyads for link in dyad.links}
    for link in wide_sliders_of(report):
        digits = ids.joint(carriers(linkage)[link], link)
        below = ids.face_below(link) if ids.face_below(link) in report.ledger else ""
        pin = NamedPoint(pins[link])
        sliders.append(WideSlider(link, digits, pin, ids.face_from(link), ids.face_to(link), below))
    return tuple(sliders)


def face_state(report: ReportContext, slider: WideSlider, k: int) -> str:
    """Return the key of the phrase for the state of a slider in its guide: "tilts" or "within"."""
    return "tilts" if tilts(report, slider.digits, k) else "within"


def rows(report: ReportContext, digits: str) -> Iterator[Sequence[object]]:
    """Yield for each position the reaction, its place, whether the slider tilts, and both ends if it does."""
    words = report.words["tables"]["faces"]
    ends = [ids.face_reaction(digits, number) for number in (1, 2)]
    for k in report.all_positions:
        tilting = tilts(report, digits, k)
        at_ends = [bare(report, id, k) for id in ends] if tilting else ["–", "–"]
        values = [bare(report, name(digits), k) for name in (ids.normal_reaction, ids.normal_place)]
        yield str(k), *values, words["tilts" if tilting else "within"], *at_ends


HOOKS = ViewHooks(
    values={"wide_sliders": wide_sliders},
    functions={"face_state": face_state},
    tables={"faces": RowTable(rows, (16.0, 26.0, 26.0, 36.0, 28.0, 28.0))},
    passages={"given": always("faces-given"), "task": always("faces-task")},
)
