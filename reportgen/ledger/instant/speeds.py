"""Velocities, step by step: from a body whose rates are known over its points to the next body."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import combinations, permutations

from reportgen.catalogue import plane_motion_file as file
from reportgen.catalogue.plane_motion_centres import NEAR, Centre
from reportgen.ledger.instant.board import Board, Projected, Step, Vector, towards
from reportgen.notation.expressions import Symbol
from reportgen.plane_motion.ways import parallel, perpendicular


def enter_given(board: Board) -> None:
    """The rates that the file gives."""
    q = board.q
    for rate in board.layout.given.given:
        match rate:
            case file.OmegaOf(body=body, value=value):
                board.given(f"omega.{body}", value.si)
            case file.VelocityOf(point=point, size=size) if size is not None:
                board.given(f"v.{point}", size.si)
            case file.FromRest(point=point, acceleration=acceleration, time=time):
                a = board.given(f"a.{point}", acceleration.si)
                t = board.given("t", time.si, symbol=Symbol("t"), kind="time")
                q.define(f"v.{point}", a * t)
                board.steps.append(Step("from-rest", (f"v.{point}",), point=point))


def derive(board: Board) -> bool:
    """One more body whose rate, or whose points' velocities become known; whether there was one."""
    known = _about(board, board.layout.centres.values()) or _by_belt(board)
    return known or by_parallels(board) or by_moving_frame(board)


def about_joints(board: Board) -> bool:
    """The same of a body that a joint makes turn about a fixed point or move in translation, by no method."""
    return _about(board, (one for one in board.layout.centres.values() if one.by_joint)) or _by_belt(board)


def by_centre(board: Board) -> bool:
    """The same of a body in plane motion, about its instant centre."""
    return _about(board, (one for one in board.layout.centres.values() if not one.by_joint)) or by_parallels(board)


def by_parallels(board: Board) -> bool:
    """ω of one more body from two parallel velocities."""
    return any(_parallel(board, body, names) for body, names in board.layout.members.items())


def by_moving_frame(board: Board) -> bool:
    """One more point along a line of a moving body."""
    given = board.layout.given
    return any(_slot(board, joint) for joint in given.slots) or enter_blocks(board, "omega")


def enter_blocks(board: Board, what: str) -> bool:
    """One more body that turns as the one does along whose guide it slides; `what` is omega or eps."""
    for joint in board.layout.given.joints:
        if isinstance(joint, file.Slider) and joint.on:
            for known, new in permutations((joint.body, joint.on)):
                if board.knows(f"{what}.{known}") and not board.knows(f"{what}.{new}"):
                    id = board.q.define(f"{what}.{new}", board.q[f"{what}.{known}"]).id
                    board.steps.append(Step(f"block-{what}", (id,), new, frame=known))
                    return True
    return False


def _by_belt(board: Board) -> bool:
    """The rim of one more disc that turns about a fixed centre moves as fast as the belt."""
    for index, ends in board.layout.belts.items():
        joint = board.layout.given.joints[index]
        if not (isinstance(joint, file.Belt) and board.layout.turn_on_ground(joint.discs)):
            continue
        for (base, _), (point, body) in permutations(zip(ends, joint.discs, strict=True)):
            if board.knows(f"v.{base}") and not board.knows(f"v.{point}"):
                board.q.define(f"v.{point}", board.q[f"v.{base}"])
                board.steps.append(Step("belt", (f"v.{point}",), body, point, base))
                return True
    return False


def _about(board: Board, centres: Iterable[Centre]) -> bool:
    for centre in centres:
        if centre.rule == "translation":
            if _translation(board, centre.body, centre):
                return True
        elif _rate(board, centre.body, centre) or _points(board, centre.body, centre):
            return True
    return False


def _translation(board: Board, body: int, centre: Centre) -> bool:
    """All points have one velocity."""
    q, names = board.q, board.layout.members[body]
    known = next((name for name in names if board.knows(f"v.{name}")), "")
    new = [name for name in names if known and not board.knows(f"v.{name}")]
    if not known or (not new and board.knows(f"omega.{body}")):
        return False
    if not board.knows(f"omega.{body}"):
        q.give(f"omega.{body}", 0.0)
    ids = tuple(q.define(f"v.{name}", q[f"v.{known}"]).id for name in new)
    if ids or centre.points:
        board.steps.append(Step("translation", ids, body, ", ".join(new), known))
    return True


def _rate(board: Board, body: int, centre: Centre) -> bool:
    """ω = v/l from one velocity, about the centre."""
    if board.knows(f"omega.{body}"):
        return False
    names = board.layout.members[body]
    known = [name for name in names if board.knows(f"v.{name}") and not board.layout.is_centre(centre, name)]
    if not known:
        return False
    arm = board.length(centre.name, known[0], centre.at)
    board.q.define(f"omega.{body}", board.q[f"v.{known[0]}"] / arm)
    board.steps.append(Step(f"rate-{centre.rule}", (arm.id, f"omega.{body}"), body, known[0], centre.name))
    return True


def _points(board: Board, body: int, centre: Centre) -> bool:
    """v = ω l of every point, about the centre; what is at the centre is at rest."""
    q, layout = board.q, board.layout
    new = [name for name in layout.members[body] if not board.knows(f"v.{name}")]
    if not new or not board.knows(f"omega.{body}"):
        return False
    for name in new:
        if layout.is_centre(centre, name):
            q.give(f"v.{name}", 0.0)
            kind = "at-rest" if centre.rule == "normals" else ""
            ids: tuple[str, ...] = ()
        else:
            arm = board.length(centre.name, name, centre.at)
            q.define(f"v.{name}", q[f"omega.{body}"] * arm)
            kind, ids = f"speed-{centre.rule}", (arm.id, f"v.{name}")
        if kind:
            board.steps.append(Step(kind, ids, body, name, centre.name))
    return True


def is_across(board: Board, *names: str) -> bool:
    """Whether points lie on one line and their velocities are all perpendicular to it."""
    points, ways = board.layout.points, board.layout.ways
    line = board.way(points[names[1]] - points[names[0]])
    if not line or any(name not in ways for name in names):
        return False
    in_line = all(abs((line.conjugate() * (points[name] - points[names[0]])).imag) < NEAR for name in names)
    return in_line and all(perpendicular(ways[name], line) for name in names)


def _parallel(board: Board, body: int, names: list[str]) -> bool:
    """ω from two velocities that are perpendicular to the line of their points."""
    q = board.q
    if body in board.layout.centres:
        return False
    known = [name for name in names if board.knows(f"v.{name}")]
    for one, other in combinations(known, 2):
        if not is_across(board, one, other):
            continue
        if not board.knows(f"omega.{body}"):
            v, w = board.at(one), board.at(other)
            first, second = (one, other) if abs(v) >= abs(w) else (other, one)
            same = (v.conjugate() * w).real >= 0
            difference = q[f"v.{first}"] - q[f"v.{second}"] if same else q[f"v.{first}"] + q[f"v.{second}"]
            q.define(f"omega.{body}", difference / board.length(one, other))
            board.steps.append(Step("rate-parallel", (f"omega.{body}",), body, one, other))
            return True
    return False


# --- a point along the line of a moving body --------------------------------------------------------


def _slot(board: Board, joint: file.SlotJoint) -> bool:
    """v_P = v_X + v_PX + v_r for a point P on a line of a body with a known point X, with two unknown sizes."""
    body, point, q, layout = joint.on, joint.point, board.q, board.layout
    if board.knows(f"v.{point}.r"):
        return False
    base = _base(board, body)
    if base is None or not (board.knows(f"v.{point}") or board.knows(f"omega.{body}")):
        return False
    u = layout.geometry.direction(joint)
    arm_way = layout.points[point] - layout.points[base]
    if abs(arm_way) < NEAR or (not board.knows(f"omega.{body}") and perpendicular(u, arm_way / abs(arm_way))):
        # As the body turns, its own point moves along the line alone, which tells nothing of how fast.
        return False
    known_rate, new = board.knows(f"omega.{body}"), not board.knows(f"v.{point}")
    if new and (point not in layout.ways or parallel(layout.ways[point], u)):
        return False
    own = board.at(point, body)
    turning = Vector(f"v.{point}{base}", board.way(own - board.at(base, body)))
    sliding = Vector(f"v.{point}.r", board.way(board.at(point) - own))
    bases, whole, arm = board.nonzero(board.velocity(base)), board.velocity(point), board.length(base, point)
    lines = (q.define(turning.id, q[f"omega.{body}"] * arm).id,) if known_rate else ()
    equation = Projected(board, (whole,), (*bases, turning, sliding), lines)
    if new:
        equation.find(whole, 1j * u, "η", point)
    elif not known_rate:
        size = equation.find(turning, 1j * u, "η", point)
        equation.then(q.define(f"omega.{body}", size / arm))
    symbol = Symbol("v", point, "r")
    if sliding.way:
        equation.find(sliding, towards(u, arm_way), "ξ", point, symbol, "velocity")
    else:
        q.give(sliding.id, 0.0, symbol, "velocity")
    equation.step("slot-speed" if known_rate else "slot-rate", body, point, base)
    return True


def _base(board: Board, body: int) -> str | None:
    """A point of a body whose velocity is known: its pivot, or one that another body carries."""
    centre = board.layout.centres.get(body)
    if centre is not None and centre.rule in ("pivot", "contact"):
        if not board.knows(f"v.{centre.name}"):
            board.q.give(f"v.{centre.name}", 0.0)
        return centre.name
    return next((name for name in board.layout.members[body] if board.knows(f"v.{name}")), None)
