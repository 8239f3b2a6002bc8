"""Couples of guides: a guide whose force is zero may still exert a moment about the slider's pin.

`M.03` is the moment of all other loads on link 3 about the pin; the couple of the guide is equal and opposite to it.
"""

from __future__ import annotations

from reportgen.derivation.load_entries import Polygon
from reportgen.drawing.force_drawings import Couple
from reportgen.formula import Symbol, ids, size
from reportgen.report.context import ReportContext
from reportgen.report.link_views import Contact


def is_couple(report: ReportContext, contact: Contact, k: int) -> bool:
    """Return True if the guide exerts no force at position `k` but must balance a moment about its pin."""
    moment = contact.moment
    return moment in report.ledger and report.is_zero(contact.reaction, k) and not report.is_zero(moment, k)


def guide_couples(report: ReportContext) -> list[Contact]:
    """Return the slides whose guide exerts a couple at any position, the outermost group first."""
    slides = [contact for group in reversed(report.dyads) for contact in group.contacts]
    return [slide for slide in slides if any(is_couple(report, slide, k) for k in report.all_positions)]


def couple_sense(report: ReportContext, contact: Contact, k: int) -> str:
    """Return the phrase for the sense in which the guide turns the link of the slide."""
    return report.sense(-report.ledger.number(contact.moment, k).value)


def drawn(report: ReportContext, contact: Contact, link: int, k: int, at: complex) -> list[Couple]:
    """Return the couple of a guide on one of its two links as an arc `at` a place (mm); [] if the guide exerts
    a force.
    """
    if not is_couple(report, contact, k):
        return []
    moment = report.ledger.number(contact.moment, k).value
    symbol: Symbol = report.ledger.symbol(contact.moment)
    return [Couple(size(symbol), at, -moment if link == contact.link else moment)]


def handed_on(report: ReportContext, polygon: Polygon) -> list[tuple[Contact, int]]:
    """Return the slides of groups solved before that act on the links of a force plan, each with the link it
    acts on.
    """
    carried = {edge.name: edge.link for edge in polygon.carried}
    slides = [contact for group in report.dyads for contact in group.contacts]
    return [
        (slide, link)
        for slide in slides
        for name, link in carried.items()
        if name == ids.reaction_force(ids.joint(slide.link, link))
    ]
