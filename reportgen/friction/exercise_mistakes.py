"""Common mistakes in friction exercises, in addition to those that marking always looks for."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from reportgen.formula import PI, Expression, Ref, atan, cos, exp, sin, substitute
from reportgen.formula.calculation import Calculation
from reportgen.formula.ledger import MistakenValues


def changed(task: str, q: Calculation) -> dict[str, list[tuple[str, Expression]]]:
    """Return the mistakes of a task by the ids of its quantities, as far as the calculation has them."""
    mistakes: dict[str, list[tuple[str, Expression]]] = {}
    for id, name, formula in TASKS[task](q):
        if id in q:
            mistakes.setdefault(id, []).append((name, formula))
    return mistakes


def against(q: Calculation, id: str, *angles: str) -> Expression:
    """Return the formula of a quantity with some angles of friction reversed."""
    definition = q.families[id].definition
    assert definition is not None
    return substitute(definition, lambda ref: -ref if ref.id in angles else ref)


def of_incline(q: Calculation) -> MistakenValues:
    def named(name: str) -> str:
        return f"friction.incline.{name}"

    Q, α, f, φ = (Ref(named(name)) for name in ("Q", "alpha", "f", "phi"))
    yield φ.id, "coefficient-for-angle", f
    for end in ("", "lowering."):
        P, N = named(f"{end}P"), named(f"{end}N")
        yield P, "friction-sense", against(q, P, φ.id)
        yield N, "friction-weight-for-normal", Q
        yield named(f"{end}F"), "friction-weight-for-normal", f * Q
        if named("beta") in q:
            yield N, "friction-normal-without-force", Q * cos(α)
            yield P, "friction-force-along", Q * (sin(α + φ) if not end else sin(α - φ)) / cos(φ)


def of_wedge(q: Calculation) -> MistakenValues:
    places = [place for place in "123" if f"friction.wedge.phi{place}" in q]
    for place in places:
        yield f"friction.wedge.phi{place}", "coefficient-for-angle", Ref(f"friction.wedge.f{place}")
    angles = [f"friction.wedge.phi{place}" for place in places]
    for id in ("friction.wedge.P", "friction.wedge.R1", "friction.wedge.lowering.R1", "friction.wedge.lowering.P"):
        yield id, "friction-sense", against(q, id, *angles)


def of_screw(q: Calculation) -> MistakenValues:
    def of(name: str) -> Ref:
        return Ref(f"friction.screw.{name}")

    reduced = of("f.reduced") if of("f.reduced").id in q else of("f")
    yield of("phi").id, "coefficient-for-angle", reduced
    if reduced != of("f"):
        yield of("phi").id, "friction-profile", atan(of("f"))
    if q.si(of("n")) != 1:
        yield of("lead").id, "friction-starts", of("p")
        yield of("gamma").id, "friction-starts", atan(of("p") / (PI * of("d")))
        yield of("eta").id, "friction-starts", of("Q") * of("p") / (2 * PI * of("M"))
    for name in ("Mt", "lowering.Mt") if of("Mt").id in q else ("M", "lowering.M"):
        definition = q.families[of(name).id].definition
        assert definition is not None
        yield of(name).id, "diameter-for-radius", definition * 2
        yield of(name).id, "friction-sense", against(q, of(name).id, of("phi").id)
    if of("Mc").id in q:
        yield of("Mc").id, "diameter-for-radius", of("fc") * of("Q") * of("dc")


def of_drum(task: str, q: Calculation) -> MistakenValues:
    """Yield common mistakes for a band on a drum."""

    def of(name: str) -> Ref:
        return Ref(f"friction.{task}.{name}")

    yield of("k").id, "degrees-for-radians", exp(of("f") * of("theta") * 180 / PI)
    yield of("F").id, "diameter-for-radius", of("M") / of("d")
    for name, tension in (("S1", "S2"), ("S2", "S1")):
        if q.families[of(name).id].definition is None:
            continue
        if of("F").id in q:
            F, k = of("F"), of("k")
            exchanged: Expression = F / (k - 1) if name == "S1" else F / (k - 1) + F
        else:
            exchanged = of(tension) / of("k") if name == "S1" else of(tension) * of("k")
        yield of(name).id, "friction-tensions-exchanged", exchanged


def of_belt(q: Calculation) -> MistakenValues:
    yield from of_drum("belt", q)
    if "friction.belt.F" not in q:
        S1, S2, d = (Ref(f"friction.belt.{name}") for name in ("S1", "S2", "d"))
        yield "friction.belt.M", "diameter-for-radius", (S1 - S2) * d


def of_band(q: Calculation) -> MistakenValues:
    yield from of_drum("band", q)
    yield from exchanged_senses("band", q)


def of_shoe(q: Calculation) -> MistakenValues:
    yield "friction.shoe.F", "diameter-for-radius", Ref("friction.shoe.M") / Ref("friction.shoe.d")
    yield "friction.shoe.N", "friction-multiplied", Ref("friction.shoe.F") * Ref("friction.shoe.f")
    yield from exchanged_senses("shoe", q)


def exchanged_senses(task: str, q: Calculation) -> MistakenValues:
    """Yield the mistake of using the force on the lever for the other sense of rotation."""
    for id, opposite in ((f"friction.{task}.P", "backward.P"), (f"friction.{task}.backward.P", "P")):
        definition = q.families[f"friction.{task}.{opposite}"].definition
        assert definition is not None
        if q.si(id) != q.si(f"friction.{task}.{opposite}"):
            yield id, "friction-senses-exchanged", definition


TASKS: Mapping[str, Callable[[Calculation], MistakenValues]] = {
    "incline": of_incline,
    "wedge": of_wedge,
    "screw": of_screw,
    "belt": of_belt,
    "band": of_band,
    "shoe": of_shoe,
}
