"""The machines of the book as a student meets them: what is worked out before the plans, and which groups follow.

Each is a way through `Hand`: lengths and masses by the formulas of the task, the groups in the order of assembly,
the loads, then the reactions.  Nothing of the catalogue, the ledger or of marking is used.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

import numpy as np

from tests.marking.hand import MM, Hand, meet


def masses(s: Hand, *links: int) -> dict[int, float]:
    """m = G/g of the links that have a weight."""
    return {n: s.say(f"m.{n}", s.known(f"G{n}") / s.datum("g")) for n in links if f"G{n}" in s.given}


def bar(
    s: Hand, number: int, name: str, length: float, mass: Mapping[int, float], share: str = ""
) -> tuple[float, float]:
    """Where the mass centre of a bar lies from its first joint, and its moment of inertia m l²/12."""
    to_centre = s.say(f"l.{name}S{number}", s.datum(share or f"s.{number}") * length)
    moment = s.say(f"J.{number}", mass[number] * length**2 / 12)
    s.say(f"l.S{number}K{number}", moment / (mass[number] * to_centre))
    return to_centre, moment


def crank(s: Hand, centre: str, pin: str, length: float) -> None:
    """The crank, drawn about the origin."""
    s.draw(f"{centre}{pin}", length)
    s.fixed(centre, 0j)
    s.crank(centre, pin, length, s.given["phi.1"])


def rod_and_slider(
    s: Hand, links: tuple[int, int], joints: str, line: complex, length: float, shape: tuple[float, float]
) -> None:
    """A rod of a central machine with its slider, all but the working load; `shape` is as `bar` gives it."""
    (i, j), (pin, end), S = links, joints, f"S{links[0]}"
    s.rrp(links, pin, end, length, line, 0j)
    s.point(S, pin, end, i, shape[0] / length)
    centre_of_velocity(s, i, pin, end, line)
    top = abs(s.p[pin]) + s.written[f"drawn.{joints}"] * MM
    s.say(f"s.{j}", s.mu["l"] * abs(top - abs(s.p[end]) + s.ends()))
    s.body(i, S, s.written[f"m.{i}"], shape[1])
    s.body(j, end, s.written[f"m.{j}"])


def centre_of_velocity(s: Hand, link: int, pin: str, end: str, line: complex) -> None:
    """ω and the end's velocity by the point about which the rod turns, and what both ends have along the rod."""
    A, B = s.p[pin], s.p[end]
    P = meet(0j, A, B, 1j * line)
    PA, PB = (abs(abs(P - one) + s.ends()) for one in (A, B))
    if 0.002 <= PA <= 0.3 and PB <= 0.3:
        PA, PB = s.say(f"ic.seg.{link}.{pin}", PA), s.say(f"ic.seg.{link}.{end}", PB)
        s.say(f"ic.omega.{link}", s.written[f"v.{pin}"] / (s.mu["l"] * PA))
        s.say(f"ic.v.{link}", s.written[f"v.{pin}"] * PB / PA)
    for name in (pin, end):
        turned = abs(float(np.angle(s.v[name] / (B - A)))) + s.ends() / s.paper
        psi = s.say(f"ic.angle.{link}.{name}", min(max(turned, 0.0), np.pi))
        s.say(f"ic.along.{link}.{name}", s.written[f"v.{name}"] * math.cos(psi))


def engine_formulas(s: Hand, links: tuple[int, int], end: str, to_S: float, φ: float) -> None:
    """The closed formulas of a cylinder; φ from the top in the sense of rotation."""
    (i, j), S = links, f"S{links[0]}"
    R, L, ω, λ, say = s.written["R"], s.written["L"], s.speed, s.datum("lambda"), s.say
    β = say(f"beta.{i}", math.asin(λ * math.sin(φ)))
    say(f"x.{j}", R * (1 - math.cos(φ)) + L * (1 - math.cos(β)))
    say(f"f.v.{end}", ω * R * math.sin(φ + β) / math.cos(β))
    # β grows as the rod turns against the crank; ω and ε are positive anticlockwise.
    against = -s.turn
    turning = against * say(f"f.omega.{i}", against * λ * ω * math.cos(φ) / math.cos(β))
    say(f"f.a.{end}", ω**2 * R * (math.cos(φ + β) / math.cos(β) + λ * math.cos(φ) ** 2 / math.cos(β) ** 3))
    growing = -(ω**2) * λ * (1 - λ**2) * math.sin(φ) / math.cos(β) ** 3
    rising = against * say(f"f.eps.{i}", against * growing)
    vx = say(f"f.x.{S}.v", (1 - to_S / L) * ω * R * math.cos(φ))
    vy = say(f"f.y.{S}.v", -ω * R * math.sin(φ) - turning * to_S * math.sin(β))
    say(f"f.v.{S}", math.hypot(vx, vy))
    ax = -(1 - to_S / L) * ω**2 * R * math.sin(φ)
    ay = -(ω**2) * R * math.cos(φ) - to_S * (rising * math.sin(β) + turning**2 * math.cos(β))
    say(f"f.a.{S}", math.hypot(say(f"f.x.{S}.a", ax), say(f"f.y.{S}.a", ay)))


def engine_twin(s: Hand) -> None:
    """Two cylinders on one crank, the second pin ahead of the first, its rod and slider of the same weights."""
    R = s.say("R", s.datum("H") / 2)
    L = s.say("L", R / s.datum("lambda"))
    pins = [s.say(f"l.O1{pin}", R) for pin in "AC"]
    rods = [s.say(f"l.{rod}", L) for rod in ("AB", "CD")]
    area = s.say("F", math.pi * s.datum("D") ** 2 / 4)
    for number in (4, 5):
        s.say(f"G{number}", s.datum(f"G{number - 2}"))
    m = masses(s, 2, 3, 4, 5)
    shapes = [bar(s, number, pin, L, m, "s") for number, pin in ((2, "A"), (4, "C"))]
    ahead = s.given["crank.angle"]
    crank(s, "O1", "A", pins[0])
    s.on_crank("C", "O1", "A", pins[1], ahead)
    top = s.turn * (s.given["phi.1"] - math.pi / 2)
    cylinders = zip(((2, 3), (4, 5)), ("AB", "CD"), rods, shapes, (top, top + ahead), strict=True)
    for links, joints, length, shape, φ in cylinders:
        j, end = links[1], joints[1]
        rod_and_slider(s, links, joints, 1j, length, shape)
        s.force(f"P{j}", j, end, -1j * s.say(f"P{j}", s.say(f"p.{j}", s.given[f"p.{j}"]) * area))
        engine_formulas(s, links, end, shape[0], φ)
    s.reactions("O1", "A")


def slider_crank(s: Hand) -> None:
    """A central slider-crank, level, with a given force on the slider."""
    L = s.datum("l.BC")
    shape = bar(s, 2, "B", L, masses(s, 2, 3), "s")
    crank(s, "A", "B", s.datum("l.AB"))
    rod_and_slider(s, (2, 3), "BC", 1 + 0j, L, shape)
    s.force("P3", 3, "C", s.say("P3", s.given["P3"]) + 0j)
    s.reactions("A", "B")


def engine_single(s: Hand) -> None:
    """An offset cylinder: R and L from the stroke, the offset and the ratio of the times of both strokes."""
    e, H, K = s.datum("e"), s.datum("H"), s.datum("K")
    θ = s.say("theta", math.pi * (K - 1) / (K + 1))
    q1 = s.say("q.1", 2 * H * e * math.tan(θ / 2))
    q2 = s.say("q.2", 2 * H * e / math.tan(θ / 2))
    R, L = s.say("R", math.sqrt(H**2 - q1) / 2), s.say("L", math.sqrt(H**2 + q2) / 2)
    BS = s.say("l.BS2", s.datum("s") * L)
    AB, BC = s.say("l.AB", R), s.say("l.BC", L)
    area = s.say("F", math.pi * s.datum("D") ** 2 / 4)
    m = masses(s, 1, 2, 3)
    J = s.say("J.2", m[2] * (s.datum("rho") * L) ** 2)
    s.say("l.S2K2", J / (m[2] * BS))
    crank(s, "A", "B", AB)
    s.rrp((2, 3), "B", "C", BC, 1j, s.turn * -e + 0j)
    s.point("S2", "B", "C", 2, BS / BC)
    top = math.sqrt((s.written["drawn.BC"] * MM + s.paper) ** 2 - (e / s.drawing) ** 2)
    s.say("s.3", s.mu["l"] * (top - s.p["C"].imag + s.ends()))
    s.force("P3", 3, "C", -1j * s.say("P3", s.say("p.3", s.given["p.3"]) * area))
    s.body(2, "S2", m[2], J)
    s.body(3, "C", m[3])
    s.weight(1, "A")
    s.reactions("A", "B")


def engine_v(s: Hand) -> None:
    """A main rod with a boss, a second rod on it; the sliders move on lines at α and β from x."""
    L = s.datum("l.BC")
    s.say("lambda", s.say("R", s.datum("l.AB")) / s.say("L", L))
    crank(s, "A", "B", s.datum("l.AB"))
    one, other = (np.exp(1j * s.datum(angle)) for angle in ("alpha", "beta"))
    s.rrp((2, 3), "B", "C", L, one, 0j)
    s.point("D", "B", "C", 2, s.datum("l.BD") / L)
    s.rrp((4, 5), "D", "E", s.datum("l.DE"), other, 0j)
    s.force("P3", 3, "C", -one * s.datum("P3"))
    s.force("P5", 5, "E", -other * s.datum("P5"))
    s.reactions("A", "B")


def four_bar(s: Hand) -> None:
    """Crank, coupler with two points, rocker with a torque; Grashof's sums and the two outer positions."""
    a, b, c, d = (s.datum(f"l.{name}") for name in ("AB", "BC", "DC", "AD"))
    m = masses(s, 2, 3)
    along, across = s.datum("E.along"), s.datum("E.across")
    BE = s.say("l.BE", math.hypot(along, across))
    CE = s.say("l.CE", math.hypot(b - along, across))
    BS, J2 = bar(s, 2, "B", b, m)
    DS, J3 = bar(s, 3, "D", c, m)
    s.say("sum.ends", a + d)
    s.say("sum.others", b + c)
    far, near = s.say("l.AC1", b + a), s.say("l.AC2", b - a)
    alpha1 = s.say("alpha.1", math.acos((far**2 + d**2 - c**2) / (2 * far * d)))
    alpha2 = s.say("alpha.2", math.acos((near**2 + d**2 - c**2) / (2 * near * d)))
    psi1 = s.say("psi.1", math.acos((d**2 + c**2 - far**2) / (2 * d * c)))
    psi2 = s.say("psi.2", math.acos((d**2 + c**2 - near**2) / (2 * d * c)))
    θ = s.say("theta", alpha2 - alpha1)
    s.say("K", (math.pi + θ) / (math.pi - θ))
    s.say("swing", abs(psi1 - psi2))
    crank(s, "A", "B", a)
    s.fixed("D", d + 0j)
    s.rrr((2, 3), "BCD", (b, c), 1)
    # The triangle BCE from its three sides.
    x = (BE**2 + b**2 - CE**2) / (2 * b)
    s.point("E", "B", "C", 2, complex(x, math.copysign(math.sqrt(BE**2 - x**2), across)) / b)
    s.point("F", "B", "C", 2, s.datum("l.BF") / b)
    s.point("S2", "B", "C", 2, BS / b)
    s.point("S3", "D", "C", 3, DS / c)
    s.body(2, "S2", m[2], J2)
    s.body(3, "S3", m[3], J3)
    s.torque("M3", 3, s.datum("M3"))
    s.reactions("A", "B")


def lever_six_bar(s: Hand) -> None:
    """Crank BA about B, rod AC with E on it, lever DC, rod EF with a slider on a horizontal line."""
    a, b, c, ef = (s.datum(f"l.{name}") for name in ("BA", "AC", "DC", "EF"))
    m = masses(s, 2, 3, 4, 5)
    AE = s.say("l.AE", b - s.datum("l.CE"))
    BS = s.say("l.BS1", s.datum("s.1") * a)
    AS, J2 = bar(s, 2, "A", b, m)
    DS, J3 = bar(s, 3, "D", c, m)
    ES, J4 = bar(s, 4, "E", ef, m)
    crank(s, "B", "A", a)
    s.fixed("D", complex(s.datum("D.x"), s.datum("D.y")))
    s.on_crank("S1", "B", "A", BS)
    s.rrr((2, 3), "ACD", (b, c), 1)
    s.point("E", "A", "C", 2, AE / b)
    s.point("S2", "A", "C", 2, AS / b)
    s.point("S3", "D", "C", 3, DS / c)
    s.rrp((4, 5), "E", "F", ef, -1 + 0j, 1j * s.datum("F.y"))
    s.point("S4", "E", "F", 4, ES / ef)
    for link, centre, moment in ((2, "S2", J2), (3, "S3", J3), (4, "S4", J4), (5, "F", None)):
        s.body(link, centre, m[link], moment)
    s.force("P5", 5, "F", s.datum("P5") + 0j)
    s.reactions("B", "A")


def toggle_press(s: Hand) -> None:
    """Crank OA, rod AB, the two links of the toggle, the ram below D."""
    a, ab, l, bc = (s.datum(f"l.{name}") for name in ("OA", "AB", "DB", "BC"))  # noqa: E741
    m = masses(s, 2, 3, 4, 5)
    AS, J2 = bar(s, 2, "A", ab, m)
    DS, J3 = bar(s, 3, "D", l, m)
    BS, J4 = bar(s, 4, "B", bc, m)
    crank(s, "O", "A", a)
    s.fixed("D", complex(s.datum("D.x"), s.datum("D.y")))
    s.rrr((2, 3), "ABD", (ab, l), 1)
    s.rrp((4, 5), "B", "C", bc, -1j, complex(s.datum("D.x"), 0.0))
    for name, one, other, link, at in (("S2", "A", "B", 2, AS / ab), ("S3", "D", "B", 3, DS / l)):
        s.point(name, one, other, link, at)
    s.point("S4", "B", "C", 4, BS / bc)
    for link, centre, moment in ((2, "S2", J2), (3, "S3", J3), (4, "S4", J4), (5, "C", None)):
        s.body(link, centre, m[link], moment)
    s.force("P5", 5, "C", 1j * s.say("P5", s.given["P5"]))
    s.reactions("O", "A")


def linkage_8(s: Hand) -> None:
    """A crank and three groups, each hung on the one before; the ram below runs along y = 240 mm."""
    lengths = {name: s.datum(f"l.{name}") for name in ("AB", "BC", "DC", "EF", "GF", "HK")}
    m = masses(s, 2, 5, 7)
    s.draw("AB", lengths["AB"])
    for name in "ADG":
        s.fixed(name, complex(s.datum(f"frame.x.{name}"), s.datum(f"frame.y.{name}")))
    s.crank("A", "B", lengths["AB"], s.given["phi.1"])
    s.rrr((2, 3), "BCD", (lengths["BC"], lengths["DC"]), 1)
    s.point("E", "B", "C", 2, (0.110 + 0.060j) / lengths["BC"])
    s.rrr((4, 5), "EFG", (lengths["EF"], lengths["GF"]), 1)
    s.point("H", "G", "F", 5, (0.130 + 0.030j) / lengths["GF"])
    s.rrp((6, 7), "H", "K", lengths["HK"], 1 + 0j, 0.240j)
    s.body(2, "E", m[2], s.datum("J.2"))
    s.body(5, "H", m[5], s.datum("J.5"))
    s.body(7, "K", m[7])
    s.force("P7", 7, "K", s.say("P7", s.given["P7"]))
    s.torque("M3", 3, s.datum("M3"))
    s.reactions("A", "B")


def linkage_slide(s: Hand) -> None:
    """A ram as the driver, a lever, a press."""
    lengths = {name: s.datum(f"l.{name}") for name in ("BC", "DC", "EF")}
    m = masses(s, 3, 5)
    s.slide("B", s.say("s.1", s.given["s.1"]), s.datum("v.B"))
    s.fixed("D", complex(s.datum("frame.x.D"), s.datum("frame.y.D")))
    s.rrr((2, 3), "BCD", (lengths["BC"], lengths["DC"]), 1)
    s.point("E", "D", "C", 3, (0.060 - 0.200j) / lengths["DC"])
    s.point("S3", "D", "C", 3, (0.080 - 0.060j) / lengths["DC"])
    s.rrp((4, 5), "E", "F", lengths["EF"], 1j, 0.520 + 0j)
    s.body(3, "S3", m[3], s.datum("J.3"))
    s.body(5, "F", m[5])
    s.force("P5", 5, "F", 1j * s.say("P5", s.given["P5"]))
    s.torque("M3", 3, s.datum("M3"))
    s.reactions("", "B")


def shaper(s: Hand) -> None:
    """A slotted lever about C below the crank, a link to the ram."""
    a, b, l3, l4 = s.datum("a"), s.datum("b"), s.datum("l.CD"), s.datum("l.DE")
    l1 = s.say("l.AB", a * s.datum("H") / (2 * l3))
    m = masses(s, 3, 5)
    CS = s.say("l.CS3", s.datum("s.3") * l3)
    crank(s, "A", "B", l1)
    s.drawn("AC", a)
    s.fixed("C", -1j * a)
    s.rpr((2, 3), "B", "C")
    s.on_lever("D", "B3", l3)
    s.on_lever("S3", "B3", CS)
    s.rrp((4, 5), "D", "E", l4, -1 + 0j, 1j * (b - a))
    s.body(3, "S3", m[3], s.datum("J.3"))
    s.body(5, "E", m[5])
    s.force("P5", 5, "E", s.datum("P5") + 0j)
    s.reactions("A", "B")


def slotted_lever(s: Hand) -> None:
    """A slotted lever about C below the crank, with a torque on it."""
    a, l1, l3 = s.datum("l.AC"), s.datum("l.AB"), s.datum("l.CD")
    m = masses(s, 2, 3)
    CS = s.say("l.CS3", s.datum("s.3") * l3)
    crank(s, "A", "B", l1)
    s.drawn("AC", a)
    s.fixed("C", -1j * a)
    s.rpr((2, 3), "B", "C")
    s.on_lever("D", "B3", l3)
    s.on_lever("S3", "B3", CS)
    s.body(2, "B", m[2])
    s.body(3, "S3", m[3], s.datum("J.3"))
    s.torque("M3", 3, s.datum("M3"))
    s.reactions("A", "B")


def scotch_yoke(s: Hand) -> None:
    """A block in the slot of a yoke that slides along x; B of the yoke stands on the line of the guide."""
    R = s.datum("l.OA")
    m = masses(s, 2, 3)
    crank(s, "O", "A", R)
    s.rpp((2, 3), "A", 1 + 0j)
    s.p["B"], s.v["B"], s.a["B"], s.link_of["B"] = s.p["A3"].real + 0j, s.v["A3"], s.a["A3"], 3
    s.tell("v", "B")
    s.tell("a", "B")
    s.say("s.3", s.mu["l"] * (s.paper - s.p["B"].real + s.ends()))
    s.body(2, "A", m[2])
    s.body(3, "B", m[3])
    s.force("P3", 3, "B", s.say("P3", s.given["P3"]))
    s.reactions("O", "A")


def linkage(s: Hand) -> None:
    """The two linkages of the repository that a file declares: the one with a crank, the one with a sliding driver."""
    (linkage_slide if "span" in s.given else linkage_8)(s)


WAYS: Mapping[str, Callable[[Hand], None]] = {
    "engine-twin": engine_twin,
    "slider-crank": slider_crank,
    "engine-single": engine_single,
    "engine-v": engine_v,
    "four-bar": four_bar,
    "lever-six-bar": lever_six_bar,
    "linkage": linkage,
    "scotch-yoke": scotch_yoke,
    "shaper": shaper,
    "slotted-lever": slotted_lever,
    "toggle-press": toggle_press,
}
"""The way through the machines of each kind."""

MACHINES = (
    "engine-twin-05",
    "slider-crank-01",
    "engine-single-III",
    "engine-v-01",
    "four-bar-01",
    "lever-six-bar-01",
    "linkage-8",
    "linkage-slide",
    "scotch-yoke-01",
    "shaper-02",
    "slotted-lever-02",
    "toggle-press-01",
)
"""The assignments of the repository that are worked out so."""
