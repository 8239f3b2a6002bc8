"""Calculations of the friction exercises: every quantity with its formula, one function for each task.

Friction is dry friction of Coulomb; a full reaction makes the angle φ = arctan f with the normal, against the motion.
"""

from __future__ import annotations

import math

from reportgen.base.units import MM, nice_up
from reportgen.formula import PI, Expression, Number, Ref, atan, cos, exp, sin, sqrt, tan
from reportgen.formula.calculation import Calculation
from reportgen.formula.vocabulary import KeyChapter
from reportgen.friction.friction_file import Band, BeltOnDrum, Incline, Screw, Shoe, Wedge

TALL = 75.0
"""Largest length of the greatest force of a plan on a page (mm)."""
STRAIGHT = Number(180.0, unit="°")


def force_scale(*forces: float) -> float:
    """Return a round scale (N per m of paper) at which the largest of some forces (N) fits the page."""
    return nice_up(max(map(abs, forces)) / TALL) * MM


def incline_calculation(given: Incline) -> Calculation:
    """Calculate a body on a plane: P = Q sin(α + φ)/cos(β − φ) raises it, P′ = Q sin(α − φ)/cos(β + φ) lowers it."""
    q = Calculation()
    with q.within(KeyChapter.data):
        Q, α = q.give("friction.incline.Q", given.Q.si), q.give("friction.incline.alpha", given.alpha.si)
        f = q.give("friction.incline.f", given.f)
        β: Ref | None = None
        if given.beta is not None and given.beta.si:
            β = q.give("friction.incline.beta", given.beta.si)
    with q.within(KeyChapter.geometry):
        if given.beta is None:
            β = q.define("friction.incline.beta", -α)
            q.set_out("angles", β)
        φ = q.define("friction.incline.phi", atan(f))
    with q.within(KeyChapter.forces):
        raising, lowering = (cos(φ), cos(φ)) if β is None else (cos(β - φ), cos(β + φ))
        P = q.define("friction.incline.P", Q * sin(α + φ) / raising)
        P1 = q.define("friction.incline.lowering.P", Q * sin(α - φ) / lowering, scale=given.Q.si)
        for end, force in (("", P), ("lowering.", P1)):
            normal: Expression = Q * cos(α) if β is None else Q * cos(α) - force * sin(β)
            N = q.define(f"friction.incline.{end}N", normal)
            F = q.define(f"friction.incline.{end}F", f * N)
            q.set_out("lowering" if end else "raising", force, N, F)
        sizes = map(q.si, (Q, P, P1, q["friction.incline.N"], q["friction.incline.lowering.N"]))
        q.give("friction.incline.mu", force_scale(*sizes), optional=True)
    with q.within(KeyChapter.torque):
        P0 = q.define("friction.incline.P0", Q * sin(α) if β is None else Q * sin(α) / cos(β))
        η = q.define("friction.incline.eta", P0 / P)
    q.set_out("angles", φ)
    q.set_out("efficiency", P0, η)
    return q


def wedge_calculation(given: Wedge) -> Calculation:
    """Calculate a wedge under a load: P = Q cos φ₃ sin(α + φ₁ + φ₂)/(cos φ₂ cos(α + φ₁ + φ₃)), and back with −φ."""
    q = Calculation()
    coefficients = {"1": given.f1, "2": given.f2, **({"3": given.f3} if given.f3 else {})}
    with q.within(KeyChapter.data):
        Q, α = q.give("friction.wedge.Q", given.Q.si), q.give("friction.wedge.alpha", given.alpha.si)
        f = {place: q.give(f"friction.wedge.f{place}", value) for place, value in coefficients.items()}
    with q.within(KeyChapter.geometry):
        φ = {place: q.define(f"friction.wedge.phi{place}", atan(of)) for place, of in f.items()}
        q.set_out("angles", *φ.values())
    in_guide = φ.get("3")
    borne: Expression = Q if in_guide is None else Q * cos(in_guide)

    def across(angle: Expression) -> Expression:
        """Return the force on the guide of the load from R₁ at an angle from the vertical."""
        part = q.find("friction.wedge.R1" if angle == driving else "friction.wedge.lowering.R1")
        assert part is not None
        return part * sin(angle) if in_guide is None else part * sin(angle) / cos(in_guide)

    driving = α + φ["1"]
    # A block that leans back touches the other side of its guide, where friction turns the reaction the other way.
    leans_back = q.si(α) < q.si(φ["1"])
    returning = φ["1"] - α if leans_back else α - φ["1"]
    with q.within(KeyChapter.forces):
        raised = cos(driving if in_guide is None else driving + in_guide)
        P = q.define("friction.wedge.P", borne * sin(driving + φ["2"]) / (cos(φ["2"]) * raised))
        R1 = q.define("friction.wedge.R1", borne / raised)
        R2 = q.define("friction.wedge.R2", R1 * cos(driving) / cos(φ["2"]))
        R3 = q.define("friction.wedge.R3", across(driving))
        q.set_out("raising", P, R1, R2, R3)
        let_down = cos(returning if in_guide is None else returning - in_guide)
        back = q.define("friction.wedge.lowering.R1", borne / let_down)
        P1 = q.define("friction.wedge.lowering.P", back * sin(α - φ["1"] - φ["2"]) / cos(φ["2"]), scale=given.Q.si)
        q.define("friction.wedge.lowering.R2", back * cos(returning) / cos(φ["2"]))
        q.define("friction.wedge.lowering.R3", across(returning), scale=given.Q.si)
        q.set_out("lowering", back, P1, "friction.wedge.lowering.R2", "friction.wedge.lowering.R3")
        q.give("friction.wedge.mu", force_scale(*map(q.si, (Q, P, R1, R2, R3, back))), optional=True)
    with q.within(KeyChapter.torque):
        P0 = q.define("friction.wedge.P0", Q * tan(α))
        q.set_out("efficiency", P0, q.define("friction.wedge.eta", P0 / P))
    return q


def screw_calculation(given: Screw) -> Calculation:
    """Calculate a screw: M = Q d₂/2 tan(γ + φ′) + M_c, the profile in φ′ = arctan(f/cos β), η = Q l/(2π M)."""
    q = Calculation()
    with q.within(KeyChapter.data):
        Q, d = q.give("friction.screw.Q", given.Q.si), q.give("friction.screw.d", given.d.si)
        p, n = q.give("friction.screw.p", given.p.si), q.give("friction.screw.n", given.n)
        β = q.give("friction.screw.beta", given.beta.si) if given.beta.si else None
        f = q.give("friction.screw.f", given.f)
        if given.collar is not None:
            fc, dc = q.give("friction.screw.fc", given.collar.f), q.give("friction.screw.dc", given.collar.d.si)
    with q.within(KeyChapter.geometry):
        lead = q.define("friction.screw.lead", n * p)
        γ = q.define("friction.screw.gamma", atan(lead / (PI * d)))
        reduced = f if β is None else q.define("friction.screw.f.reduced", f / cos(β))
        φ = q.define("friction.screw.phi", atan(reduced))
        q.set_out("angles", lead, γ, *q.worked(reduced), φ)
    with q.within(KeyChapter.forces):
        raising, lowering = Q * d / 2 * tan(γ + φ), Q * d / 2 * tan(φ - γ)
        if given.collar is None:
            M = q.define("friction.screw.M", raising)
            back = q.define("friction.screw.lowering.M", lowering, scale=given.Q.si * given.d.si)
        else:
            Mc = q.define("friction.screw.Mc", fc * Q * dc / 2)
            Mt = q.define("friction.screw.Mt", raising)
            M = q.define("friction.screw.M", Mt + Mc)
            Mt1 = q.define("friction.screw.lowering.Mt", lowering, scale=given.Q.si * given.d.si)
            back = q.define("friction.screw.lowering.M", Mt1 + Mc, scale=given.Q.si * given.d.si)
            q.set_out("collar", Mc)
            q.set_out("raising", Mt)
            q.set_out("lowering", Mt1)
        q.set_out("raising", M)
        q.set_out("lowering", back)
    with q.within(KeyChapter.torque):
        q.set_out("efficiency", q.define("friction.screw.eta", Q * lead / (2 * PI * M)))
    return q


def wrap(q: Calculation, task: str, d: Ref, θ: Ref, f: Ref) -> tuple[Ref, Ref]:
    """Return the radius of a drum, and the factor by which the friction on it multiplies a tension: e^{fθ}, θ in
    radians.
    """
    with q.within(KeyChapter.geometry):
        r = q.define(f"friction.{task}.r", d / 2)
        radians = q.define(f"friction.{task}.radians", θ * PI / STRAIGHT)
        k = q.define(f"friction.{task}.k", exp(f * radians))
        q.set_out("grip", r, radians, k)
    return r, k


def belt_calculation(given: BeltOnDrum) -> Calculation:
    """Calculate a belt about to slip: S₁ = S₂ e^{fθ}, M = (S₁ − S₂) r, the force on the axle, the greatest pressure."""
    q = Calculation()
    with q.within(KeyChapter.data):
        d, θ = q.give("friction.belt.d", given.d.si), q.give("friction.belt.theta", given.theta.si)
        f = q.give("friction.belt.f", given.f)
        if given.b is not None:
            q.give("friction.belt.b", given.b.si)
        for name in ("S1", "S2", "M"):
            if (datum := getattr(given, name)) is not None:
                q.give(f"friction.belt.{name}", datum.si)
    r, k = wrap(q, "belt", d, θ, f)
    with q.within(KeyChapter.forces):
        if given.M is not None:
            S1, S2 = tensions(q, "belt", q["friction.belt.M"], r, k)
        else:
            S1 = q.find("friction.belt.S1") or q.define("friction.belt.S1", q["friction.belt.S2"] * k)
            S2 = q.find("friction.belt.S2") or q.define("friction.belt.S2", q["friction.belt.S1"] / k)
            M = q.define("friction.belt.M", (S1 - S2) * r)
            q.set_out("tensions", *q.worked(S1, S2), M)
        R = q.define("friction.belt.R", sqrt(S1**2 + S2**2 - 2 * S1 * S2 * cos(θ)))
        q.set_out("axle", R)
        if given.b is not None:
            q.set_out("pressure", q.define("friction.belt.p", S1 / (q["friction.belt.b"] * r)))
    return q


def tensions(q: Calculation, task: str, M: Ref, r: Ref, k: Ref) -> tuple[Ref, Ref]:
    """Return both tensions of a band that transmits a torque."""
    F = q.define(f"friction.{task}.F", M / r)
    S2 = q.define(f"friction.{task}.S2", F / (k - 1))
    S1 = q.define(f"friction.{task}.S1", S2 + F)
    q.set_out("tensions", F, S2, S1)
    return S1, S2


def band_calculation(given: Band) -> Calculation:
    """Calculate a band brake: P l = S₁ a + S₂ b in one sense of rotation, S₂ a + S₁ b in the other."""
    q = Calculation()
    with q.within(KeyChapter.data):
        M, d = q.give("friction.band.M", given.M.si), q.give("friction.band.d", given.d.si)
        θ, f = q.give("friction.band.theta", given.theta.si), q.give("friction.band.f", given.f)
        lever = q.give("friction.band.l", given.l.si)
        a, b = (q.give(f"friction.band.{name}", getattr(given, name).si, optional=True) for name in "ab")
    r, k = wrap(q, "band", d, θ, f)
    with q.within(KeyChapter.forces):
        S1, S2 = tensions(q, "band", M, r, k)
        size = q.si(S1) * math.hypot(given.a.si, given.b.si) / given.l.si
        for end, at_a, at_b in (("P", S1, S2), ("backward.P", S2, S1)):
            moment = [force * arm for force, arm in ((at_a, a), (at_b, b)) if q.si(arm)]
            turning: Expression = moment[0] if len(moment) == 1 else moment[0] + moment[1]
            q.set_out("lever", q.define(f"friction.band.{end}", turning / lever, scale=size))
    return q


def shoe_calculation(given: Shoe) -> Calculation:
    """Calculate a shoe on a lever: P l = N a ∓ F c, less if friction presses the shoe on the drum; it locks if
    a ≤ f c.
    """
    q = Calculation()
    with q.within(KeyChapter.data):
        M, d = q.give("friction.shoe.M", given.M.si), q.give("friction.shoe.d", given.d.si)
        f, lever = q.give("friction.shoe.f", given.f), q.give("friction.shoe.l", given.l.si)
        a = q.give("friction.shoe.a", given.a.si)
        c = q.give("friction.shoe.c", given.c.si) if given.c.si else None
    with q.within(KeyChapter.geometry):
        r = q.define("friction.shoe.r", d / 2)
    with q.within(KeyChapter.forces):
        F = q.define("friction.shoe.F", M / r)
        N = q.define("friction.shoe.N", F / f)
        q.set_out("shoe", r, F, N)
        pressed: tuple[Expression, Expression] = (N * a, N * a) if c is None else (N * a - F * c, N * a + F * c)
        size = q.si(N) * given.a.si / given.l.si
        for end, moment in zip(("P", "backward.P"), pressed, strict=True):
            q.set_out("lever", q.define(f"friction.shoe.{end}", moment / lever, scale=size))
        q.set_out("locking", q.define("friction.shoe.locking", a / f))
    return q
