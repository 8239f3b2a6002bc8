"""Counterweights on the links of a machine, and their computation for slider-cranks and four-bar linkages.

The rod of a slider-crank is replaced by two point masses, one turning with the crank's pin and one reciprocating. A
four-bar's mass centre is at rest if the loop equation is used to eliminate its coupler and the remaining products
at crank and rocker are zero.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Literal

from reportgen.base.records import Record, replace
from reportgen.machine import DRIVER, GROUND, Crank, Dyad, Guide, Inertia, Linkage, LinkPoint

BESIDE = 1e-12
"""A mass centre nearer to its rod than this share of its length lies on it."""

CounterweightRule = Literal["rms", "max", "rotating", "share"]
"""Rule by which a counterweight on the crank is chosen."""


class Balancing(Record):
    """Balancing in a report: the shaking force alone, a counterweight on the crank, or counterweights on the `links`.

    A counterweight on the crank follows the first of the `rules`, and is compared with the others; those on the `links`
    balance all force. `share` is the share of the reciprocating masses for the rule of that name, `radius` r_c (m).
    """

    rules: tuple[CounterweightRule, ...] = ()
    share: float = 0.0
    links: tuple[int, ...] = ()
    radius: float = 0.0


class Counterweight(Record):
    """A counterweight on a link: U = m_c r_c e^{iψ} (kg·m) in the link's frame, `radius` r_c (m) from its pivot."""

    link: int
    product: complex
    radius: float

    @property
    def mass(self) -> float:
        """m_c = U/r_c (kg)."""
        return abs(self.product) / self.radius

    @property
    def place(self) -> complex:
        """Place of its mass centre in the link's frame (m)."""
        return self.radius * self.product / abs(self.product) if self.product else 0j


def balanced(linkage: Linkage, weights: Iterable[Counterweight]) -> Linkage:
    """Return the linkage with counterweights as further masses, at points called W and the number of their link."""
    some = [weight for weight in weights if weight.product]
    points = (LinkPoint(f"W{weight.link}", weight.link, weight.place) for weight in some)
    bodies = (Inertia(weight.link, f"W{weight.link}", weight.mass) for weight in some)
    return replace(linkage, points=(*linkage.points, *points), inertias=(*linkage.inertias, *bodies))


class CrankRod(Record):
    """A slider's rod on the crank as two point masses: m_A turns with the pin, m_B reciprocates with the slider.

    m_A = m (1 − s), m_B = m s with s = l_AS/l give the same force, though not the same moment.  The rod lies between
    `crank_pin` and `end`; `centre` is the name of its mass centre, "" without mass.  `pin` is the pin's place on the
    crank (m), `turning` m_A and `reciprocating` m_B with the slider's mass (kg).
    """

    rod: int
    slider: int
    crank_pin: str
    end: str
    centre: str
    pin: complex
    turning: float
    reciprocating: float


def crank_rods(linkage: Linkage) -> tuple[CrankRod, ...]:
    """Return the rods of all sliders.

    It is () unless every group is a straight rod from the crank to a slider on the frame, with its mass centre on the
    rod.
    """
    driver = linkage.driver
    if not isinstance(driver, Crank) or linkage.triads:
        return ()
    pins = {driver.pin: complex(driver.length)}
    pins |= {point.name: point.local for point in linkage.points if point.link == DRIVER}
    masses = {body.link: body for body in linkage.inertias}
    rods = []
    for dyad in linkage.dyads:
        i, j = dyad.links
        pin, fixed = str(dyad.start), isinstance(dyad.end, Guide) and dyad.end.link == GROUND
        rod, slider = masses.get(i), masses.get(j)
        centre = 0j if rod is None else place_on_link(linkage, i, rod.centre)
        if dyad.kind != "RRP" or pin not in pins or not fixed or abs(centre.imag) > BESIDE * dyad.lengths[0]:
            return ()
        mass, share = (rod.mass if rod else 0.0), centre.real / dyad.lengths[0]
        to_and_fro = mass * share + (slider.mass if slider else 0.0)
        called = rod.centre if rod else ""
        rods.append(
            CrankRod(
                rod=i,
                slider=j,
                crank_pin=pin,
                end=dyad.middle,
                centre=called,
                pin=pins[pin],
                turning=mass * (1 - share),
                reciprocating=to_and_fro,
            )
        )
    return tuple(rods)


def place_on_link(linkage: Linkage, link: int, name: str) -> complex:
    """Return the place of a named point in the frame of its link (m)."""
    driver = linkage.driver
    points = {point.name: point.local for point in linkage.points if point.link == link}
    if link == DRIVER and isinstance(driver, Crank):
        points |= {driver.centre: 0j, driver.pin: complex(driver.length)}
    for triad in linkage.triads:
        if link == triad.plate:
            points |= {leg.inner: local for leg, local in zip(triad.legs, triad.locals, strict=True)}
        for leg in triad.legs:
            if leg.link == link:
                points |= {leg.outer: 0j, leg.inner: complex(leg.length)}
    for dyad in linkage.dyads:
        if link not in dyad.links:
            continue
        first = link == dyad.links[0]
        length = dyad.lengths[0 if first else 1]
        outer = dyad.start if first else dyad.end
        if isinstance(outer, str):
            points.setdefault(outer, 0j)
        points.setdefault(dyad.middle, complex(length))
    return points[name]


def turning_part(linkage: Linkage) -> complex:
    """Return Σ m_A r and the crank's own m₁ r_S1 (kg·m), the product of the masses that turn with it, in its frame."""
    own = sum(
        body.mass * place_on_link(linkage, DRIVER, body.centre) for body in linkage.inertias if body.link == DRIVER
    )
    return complex(own + sum(rod.turning * rod.pin for rod in crank_rods(linkage)))


def reciprocating_part(linkage: Linkage) -> complex:
    """Return the product of the reciprocating masses at the pins: Σ (m_B + m) r (kg·m), in the crank's frame."""
    return complex(sum(rod.reciprocating * rod.pin for rod in crank_rods(linkage)))


# --- the whole balance of force of a four-bar -------------------------------------------------------


def four_bar(linkage: Linkage) -> Dyad | None:
    """Return the coupler and rocker if the linkage is a four-bar (one group of rods between crank and a fixed point),
    else None.
    """
    if not isinstance(linkage.driver, Crank) or len(linkage.groups) != 1 or linkage.triads:
        return None
    (dyad,) = linkage.dyads
    fits = dyad.kind == "RRR" and dyad.start == linkage.driver.pin and dyad.end in linkage.ground
    return dyad if fits else None


def force_balance(linkage: Linkage) -> Mapping[int, complex]:
    """Return U (kg·m) of the counterweights on crank and rocker that keep a four-bar's mass centre at rest, in their
    frames.

    With u the complex place of a link's mass centre in its frame and a, b, c the lengths of crank, coupler, rocker: U₁
    = −(m₁u₁ + m₂a(1 − u₂/b)), U₃ = −(m₃u₃ + m₂c u₂/b)   (Berkof and Lowen 1969). Raises `ValueError` for another
    linkage.
    """
    dyad = four_bar(linkage)
    if dyad is None:
        raise ValueError("no four-bar")
    coupler, rocker = dyad.links
    assert isinstance(linkage.driver, Crank)
    a, (b, c) = linkage.driver.length, dyad.lengths
    masses = {body.link: (body.mass, place_on_link(linkage, body.link, body.centre)) for body in linkage.inertias}
    (m1, u1), (m2, u2), (m3, u3) = (masses.get(link, (0.0, 0j)) for link in (DRIVER, coupler, rocker))
    return {DRIVER: -(m1 * u1 + m2 * a * (1 - u2 / b)), rocker: -(m3 * u3 + m2 * c * u2 / b)}
