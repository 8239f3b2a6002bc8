"""Reads what the printed task of any machine may have: drive, balancing, springs, faces, friction, declared loads."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from tests.report.printed_task import File, Task, columns_by_name, force_table, point_name, typed

# --- the motion under a drive ---------------------------------------------------------------------------

DRIVES = {"M_0": "M0", "k_dr": "k", "i": "ratio", "J_0": "J"}
KLOSS = {"M_k": "Mk", "s_k": "sk", "n_0": "n0"}
FROM_REST = r"the start from rest at φ = (\S+?°) from the first position"
TO_REST = r"the brake acting from φ = (\S+?°) of a steady cycle"
MOTOR = (
    r"(?P<name>[^;(]+?) \((?P<power>\S+ kW), (?P<n>\S+ rpm), starting torque (?P<start>\S+ N·m), "
    r"breakdown torque (?P<breakdown>\S+ N·m)\)"
)


def drive_motion(task: Task, data: Mapping[str, str]) -> File:
    """The drive of a machine, its start and stop; nothing where none is asked for."""
    asked = re.search(r"The machine (?:is driven|drives a load)(.*)", task.text)
    if not asked:
        return {}
    drive: File = {key: data[symbol] for symbol, key in DRIVES.items() if symbol in data}
    if "by Kloss" in asked[0]:
        drive["kloss"] = {key: data[symbol] for symbol, key in KLOSS.items()}
    elif "to be found" in asked[0]:
        drive["constant"] = "find"
    elif torques := re.search(r"with the torques (.*), linear between", asked[0]):
        points = [point.split(" at ") for point in torques[1].split("; ")]
        drive["table"] = {"n": [typed(n) for _, n in points], "M": [typed(torque) for torque, _ in points]}
    if "Choose the motor among: " in asked[0]:
        told = re.finditer(MOTOR, asked[0].partition("Choose the motor among: ")[2])
        drive["motors"] = [{key: typed(text.strip(" ;")) for key, text in one.groupdict().items()} for one in told]
    motion: File = {"drive": drive}
    if start := task.find(FROM_REST):
        motion["start"] = {"from": typed(start)}
    if stop := task.find(TO_REST):
        motion["stop"] = {"brake": data["M_br"], "from": typed(stop)}
    if ", with the flywheel" in asked[0]:
        motion["flywheel"] = "true"
    if "the forces at the true speeds" in asked[0]:
        motion["forces"] = "true"
    return {"motion": motion}


# --- what every kind may have -------------------------------------------------------------------------

RULES = {
    "rms": ("so that the mean square", "the one of least mean square"),
    "max": ("so that the maximum", "the one of least maximum"),
    "rotating": ("so that it balances the part that turns,", "the one that balances the part that turns"),
    "share": ("so that it balances the part that turns and", "the one that also balances a share"),
}
"""How the rule for a counterweight is told that is carried out, and one that is compared."""


def balancing(task: Task, data: Mapping[str, str]) -> File:
    """What is to be balanced, and how."""
    text = task.find(r"(Find the force and the moment that the inertia.*)")
    if text is None:
        return {}
    if "force whole" in text:
        return {"balancing": {"links": [1, 3], "radius": data["r_c"]}}
    if "counterweight" not in text:
        return {"balancing": {}}
    first, _, others = text.partition("Compare it with")
    # They are compared in the order of the file.
    compared = {others.find(told): rule for rule, (_, told) in RULES.items() if told in others}
    rules = [
        *(rule for rule, (chosen, _) in RULES.items() if chosen in first),
        *(compared[at] for at in sorted(compared)),
    ]
    share = {"share": data["κ"]} if "κ" in data else {}
    return {"balancing": {"counterweight": {"rules": rules, "radius": data["r_c"], **share}}}


HUNG = r"from (?P<at>\w+) on link (?P<link>\d+) to "
SIZES = r", stiffness (?P<c>.*?), free length (?P<free>.*)"
SPRINGS = (
    HUNG + r"the fixed point \((?P<x>.*?), (?P<y>.*?)\)" + SIZES,
    HUNG + r"the fixed point (?P<fixed>\w+)" + SIZES,
    HUNG + r"(?P<there>\w+) on link (?P<other>\d+)" + SIZES,
    r"a torsion spring on link (?P<link>\d+) about (?P<about>\w+), stiffness (?P<c>.*?), "
    r"slack at the angle (?P<free>.*) of the link to the x-axis",
)
FACE = (
    r"The face of slider (\d+) reaches from \S+ = (.*?) to \S+ = (.*?), counted from \w+ in the direction of its guide"
    r"(?:, at (.*?) below \w+)?\. "
)


RUBBING = re.compile(r"Friction acts in the joints: (.*?)\.(?=\s)")
GIVEN = re.compile(r"([frρ])_?(\w+) = (.*)")


def _friction(told: str) -> File:
    """What is given of the joints that rub: f_A = 0.1; r_A = 20 mm; ρ_B = 2 mm; f_3 = 0.12."""
    pins: dict[str, File] = {}
    sliders = {}
    for letter, at, value in (match.groups() for one in told.split("; ") if (match := GIVEN.fullmatch(one.strip()))):
        if at.isdigit():
            sliders[at] = typed(value)
        else:
            pins.setdefault(point_name(at), {})[{"ρ": "rho"}.get(letter, letter)] = typed(value)
    return ({"pins": pins} if pins else {}) | ({"sliders": sliders} if sliders else {})


def acceleration(task: Task, size: str) -> str:
    """An acceleration of the driving link with its sign."""
    return ("-" if "with decreasing speed" in task.text else "") + size


def additions(task: Task) -> File:
    """The plane, springs, faces of sliders, friction."""
    found: File = {"plane": "horizontal"} if "in a horizontal plane" in task.text else {}
    lines = (line.rstrip(";.") for line in task.text.splitlines())
    told = (one for line in lines for one in (re.fullmatch(pattern, line) for pattern in SPRINGS) if one)
    springs = [_spring(one.groupdict()) for one in told]
    faces = {
        link: {"from": typed(first), "to": typed(last)} | ({"below": typed(below)} if below else {})
        for link, first, last, below in re.findall(FACE, task.text)
    }
    rubbing = RUBBING.search(task.text)
    friction = {"friction": _friction(rubbing[1])} if rubbing else {}
    return found | ({"springs": springs} if springs else {}) | ({"faces": faces} if faces else {}) | friction


def _spring(told: Mapping[str, str]) -> File:
    """A spring by its ends, or about its pin."""
    spring: File = {"link": told["link"], "c": typed(told["c"]), "free": typed(told["free"])}
    if "about" in told:
        return spring | {"about": point_name(told["about"])}
    if "x" in told:
        to: Any = [typed(told["x"]), typed(told["y"])]
    else:
        to = point_name(told["fixed"]) if "fixed" in told else {"link": told["other"], "at": point_name(told["there"])}
    return spring | {"at": point_name(told["at"]), "to": to}


def declared_loads(task: Task) -> list[File]:
    """The loads that act on links besides those of the kind."""
    found = []
    for line in re.findall(r"^[PM]_\d+\w*: .*$", task.text, re.MULTILINE):
        symbol, _, words = line.partition(": ")
        link = re.search(r"(?:link|slider|piston) (\d+)", words)
        assert link is not None
        load: File = {"link": link[1]}
        if at := re.search(r"at (\w+), at (\S+°)", words):
            load |= {"at": point_name(at[1]), "direction": typed(at[2])}
        size = re.search(r"a (?:force|torque) of (.*?) on link", words)
        rows = task.table(f"Values of the load on link {link[1]}")
        if size:
            load |= {"by": "constant", "F" if symbol[0] == "P" else "M": typed(size[1])}
            load |= {"against": "motion"} if "always against" in words else {}
        elif "along its guide" in words:
            load |= force_table(rows)
        else:
            (across, over), (_, values) = columns_by_name(rows).items()
            unit = {"unit": "N"} if symbol[0] == "P" else {"torque_unit": "N m"}
            by = {"by": "way", "way": [f"{one} mm" for one in over]}
            if across == "φ":
                by = {"by": "angle", "angle": [f"{one} deg" for one in over]}
            load |= by | unit | {"values": values}
        found.append(load)
    return found
