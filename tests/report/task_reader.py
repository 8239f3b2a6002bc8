"""Reads the printed task of a machine, in English, and writes the assignment that it states.

It knows the words of a task and the keys of a file, and nothing of the program: whoever has the paper has as much.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

STROKES = ("intake", "compression", "expansion", "exhaust")
COMMON = {"n": "n", "ω_1": "omega1", "g": "g"}
LENGTHS = {
    "engine-single": {"H": "H", "K": "K", "e": "e", "R": "R", "L": "L", "D": "D", "s": "s", "ρ": "rho"},
    "engine-twin": {"H": "H", "λ": "lambda", "D": "D", "s": "s", "δ": "crank_angle"},
    "engine-v": {
        "l_AB": "AB",
        "l_BC": "BC",
        "l_BD": "BD",
        "l_DE": "DE",
        "l_BE": "DE",
        "D": "D",
        "P_C": "PC",
        "P_E": "PE",
    }
    | {"α": "alpha", "β": "beta"},
    "four-bar": {"l_AB": "AB", "l_BC": "BC", "l_CD": "CD", "l_AD": "AD", "α": "frame", "l_BF": "BF"},
    "lever-six-bar": {f"l_{rod}": rod for rod in ("AB", "AC", "CD", "CE", "EF")} | {"y_F": "guide"},
    "scotch-yoke": {"l_OA": "r", "α": "guide"},
    "shaper": {"a": "a", "b": "b", "l_3": "l3", "l_4": "l4", "H": "H"},
    "slider-crank": {"l_AB": "r", "l_BC": "l", "e": "e", "α": "guide", "s": "s"},
    "slotted-lever": {"l_AB": "AB", "l_AC": "AC", "l_CD": "CD"},
    "toggle-press": {"l_OA": "OA", "l_AB": "AB", "l_BD": "BD"},
}
"""Which key of the parameters stands for which printed symbol."""

File = dict[str, Any]


def typed(value: str) -> str:
    """A printed quantity as a file has it: 0.5 kg·m² → 0.5 kg m2."""
    return value.replace("−", "-").replace("°", " deg").replace("·", " ").replace("²", "2").replace("³", "3")


@dataclass(frozen=True)
class Task:
    """The lines of a task: sentences, and tables by their captions, each a list of rows."""

    text: str
    tables: Mapping[str, Sequence[Sequence[str]]]

    @classmethod
    def of(cls, text: str) -> Task:
        before = text.partition("Filling in the answer sheet")[0]
        tables: dict[str, list[list[str]]] = {}
        sentences, caption = [], ""
        for line in before.splitlines():
            if line.startswith("[") and line.endswith("]"):
                caption = line[1:-1]
                tables.setdefault(caption, [])
            elif " | " in line and caption:
                tables[caption].append([cell.strip() for cell in line.split("|")])
            else:
                sentences.append(line)
        return cls("\n".join(sentences), tables)

    def find(self, pattern: str) -> str | None:
        """The first group of a pattern among the sentences."""
        found = re.search(pattern, self.text)
        return found[1] if found else None

    def table(self, caption: str) -> Sequence[Sequence[str]]:
        """The table whose caption begins so; none if there is none."""
        return next((rows for name, rows in self.tables.items() if name.startswith(caption)), ())

    @property
    def data(self) -> dict[str, str]:
        """The given quantities by their symbols."""
        rows = self.table("Given data") or self.table("Lengths")
        return {symbol: typed(value) for _, symbol, value in rows[1:]}


def file_of(kind: str, text: str) -> File:
    """The assignment that a printed task states."""
    task = Task.of(text)
    data = task.data
    file: File = {"kind": kind, "positions": _positions(task)}
    if kind == "linkage":
        return file | {"parameters": _linkage(task, data)}
    symbols = COMMON | LENGTHS[kind]
    parameters: File = {symbols[symbol]: value for symbol, value in data.items() if symbol in symbols}
    for symbol, value in data.items():
        if found := re.fullmatch(r"([Gm])_(\d)|(s)_(\d)|(J)_S?([1-9]\d?)", symbol):
            letter, link = (part for part in found.groups() if part)
            parameters[letter + link] = value
    parameters |= _found(kind, task, data)
    if "δ_ω" in data:
        parameters["flywheel"] = {"delta": data["δ_ω"]}
    parameters |= _motion(task, data)
    parameters |= OWN.get(kind, lambda task, data: {})(task, data) | _further(task, data) | _balancing(task, data)
    file["parameters"] = parameters
    if rows := task.table("Indicator diagram"):
        file["indicator"] = _diagram(rows)
    if kind == "engine-twin":
        pair = re.search(r"piston 3 is on its (\w+) stroke and piston 5 on its (\w+) stroke", task.text)
        assert pair is not None
        file["indicator"]["firing"] = list(pair.groups())
    return file


def _found(kind: str, task: Task, data: Mapping[str, str]) -> File:
    """The lengths to be found of a four-bar or slider-crank, and the motion that they are to give."""
    if "The lengths that the table does not give are to be found" not in task.text:
        return {}
    unknown = {key: "find" for symbol, key in LENGTHS[kind].items() if symbol not in data}
    if kind == "four-bar":
        side = task.find(r"with A (beyond|before) the chord")
        wanted = {"swing": {"K": data["K"], "psi": data["ψ"], "A": side}}
        return {key: unknown[key] for key in ("AB", "BC", "AD") if key in unknown} | wanted
    wanted = {"stroke": {"K": data["K"], "H": data["H"]}}
    return {key: unknown[key] for key in ("r", "l", "e") if key in unknown} | wanted


def _positions(task: Task) -> File:
    """How many positions, which way the crank turns, and where it is first."""
    if at := task.find(r"[Ii]n positions? [IVX, ]+ the crank stands at (\S.*?) to the x-axis"):
        found: File = {"at": [typed(angle) for angle in at.split(", ")]}
    elif at := task.find(r"In positions? [IVX, ]+ pin \w+ stands (\S.*?) along its guide"):
        found = {"at": [typed(way) for way in at.split(", ")]}
    else:
        count = task.find(r"at (\d+) (?:equidistant )?positions")
        assert count is not None
        found = {"count": count}
    if turned := task.find(r"turns (anticlockwise|clockwise)"):
        found["direction"] = turned
    if "count" in found and (start := task.find(r"the crank stands at (\S+)° to the x-axis")):
        found["start"] = typed(f"{start}°")
    return found


# --- the motion under a drive ---------------------------------------------------------------------------

DRIVES = {"M_0": "M0", "k_dr": "k", "i": "ratio", "J_0": "J"}
KLOSS = {"M_k": "Mk", "s_k": "sk", "n_0": "n0"}
FROM_REST = r"the start from rest at φ = (\S+?°) from the first position"
TO_REST = r"the brake acting from φ = (\S+?°) of a steady cycle"
MOTOR = (
    r"(?P<name>[^;(]+?) \((?P<power>\S+ kW), (?P<n>\S+ rpm), starting torque (?P<start>\S+ N·m), "
    r"breakdown torque (?P<breakdown>\S+ N·m)\)"
)


def _motion(task: Task, data: Mapping[str, str]) -> File:
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


def _balancing(task: Task, data: Mapping[str, str]) -> File:
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
            pins.setdefault(_name(at), {})[{"ρ": "rho"}.get(letter, letter)] = typed(value)
    return ({"pins": pins} if pins else {}) | ({"sliders": sliders} if sliders else {})


def _further(task: Task, data: Mapping[str, str]) -> File:
    """The acceleration of the crank, further loads, and what every machine may have."""
    found: File = {}
    if "ε_1" in data:
        found["epsilon1"] = _accelerates(task, data["ε_1"])
    if "oads act on the links" in task.text:
        found["loads"] = _loads(task)
    return found | _beside(task)


def _accelerates(task: Task, size: str) -> str:
    """An acceleration of the driving link with its sign."""
    return ("-" if "with decreasing speed" in task.text else "") + size


def _beside(task: Task) -> File:
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
        return spring | {"about": _name(told["about"])}
    if "x" in told:
        to: Any = [typed(told["x"]), typed(told["y"])]
    else:
        to = _name(told["fixed"]) if "fixed" in told else {"link": told["other"], "at": _name(told["there"])}
    return spring | {"at": _name(told["at"]), "to": to}


# --- tables -----------------------------------------------------------------------------------------


def _rows(rows: Sequence[Sequence[str]]) -> dict[str, list[str]]:
    """A table of rows with their names in the first column, its blocks below one another put together."""
    found: dict[str, list[str]] = {}
    for name, *values in rows:
        found.setdefault(name.lower(), []).extend(typed(value) for value in values if value)
    return found


def _columns(rows: Sequence[Sequence[str]]) -> dict[str, list[str]]:
    """A table of columns folded into sets side by side."""
    head, *body = rows
    names = list(dict.fromkeys(head))
    width = len(names)
    sets = [row[first : first + width] for first in range(0, len(head), width) for row in body]
    return {name: [typed(one[i]) for one in sets if one[i]] for i, name in enumerate(names)}


def _diagram(rows: Sequence[Sequence[str]]) -> File:
    if rows[0][0] == "s/H":
        values = _rows(rows)
        return {"unit": "N/cm2", "by": "stroke", "s": values["s/h"]} | {name: values[name] for name in STROKES}
    columns = _columns(rows)
    angles = [f"{angle} deg" for angle in columns["φ"]]
    return {"unit": "N/cm2", "by": "crank_angle", "angle": angles, "p": columns["p"]}


def _force_table(rows: Sequence[Sequence[str]]) -> File:
    if rows[0][0] == "s/H":
        values = _rows(rows)
        return {"by": "stroke", "unit": "N", "s": values["s/h"]} | {way: values[way] for way in ("inward", "outward")}
    columns = _columns(rows)
    return {"by": "crank_angle", "unit": "N", "angle": [f"{angle} deg" for angle in columns["φ"]], "F": columns["P"]}


# --- what is a kind's own -----------------------------------------------------------------------------


def _working_force(task: Task, data: Mapping[str, str]) -> File:
    """A constant force with its stroke, or a table."""
    if "P" in data:
        way = task.find(r"acts only on the way (inward|outward)") or "both"
        return {"force": {"by": "constant", "F": data["P"], "stroke": way}}
    rows = task.table("Working force")
    return {"force": _force_table(rows)} if rows else {}


def _torque(task: Task, data: Mapping[str, str]) -> File:
    if "M_3" not in data:
        return {}
    sense = task.find(r"has a constant sense, (anticlockwise|clockwise)")
    return {"torque": {"M": data["M_3"], "sense": sense or "opposing"}}


def _engine_v(task: Task, data: Mapping[str, str]) -> File:
    top = task.find(r"that of piston E at its (first|second)")
    return {"second_top": "1" if top == "first" else "2"} if top else {}


def _four_bar(task: Task, data: Mapping[str, str]) -> File:
    found = _torque(task, data)
    found["branch"] = "open" if task.find(r"C lies to the (left|right)") == "left" else "crossed"
    if "ξ_E" in data:
        found["E"] = {"along": data["ξ_E"], "across": data["η_E"]}
    if "P_3" in data:
        found["force"] = {"P": data["P_3"], "angle": data["α_P"]}
    return found


def _lever(task: Task, data: Mapping[str, str]) -> File:
    found: File = {"D": {"x": data["x_D"], "y": data["y_D"]}}
    sides = re.search(r"C lies to the (left|right) of the way from A to D, F to the (left|right) of E", task.text)
    assert sides is not None
    found["C"], found["F"] = sides.groups()
    if "P_5" in data:
        sense = task.find(r"The force P_5 on the slider .*? to the (left|right)\.")
        found["force"] = {"P": data["P_5"], "sense": sense or "opposing"}
    return found


def _toggle(task: Task, data: Mapping[str, str]) -> File:
    found: File = {"D": {"x": data["x_D"], "y": data["y_D"]}, "B": task.find(r"B lies to the (left|right)")}
    if rows := task.table("Pressing force"):
        values = _rows(rows)
        found["press"] = {"unit": "N", "s": values["s/h"], "P": values["down"]}
    return found


def _slotted(task: Task, data: Mapping[str, str]) -> File:
    angle = data.get("α") or data.get("φ_CA") or data.get("α_CA")
    return _torque(task, data) | ({"axis": angle} if angle else {})


def _shaper(task: Task, data: Mapping[str, str]) -> File:
    if "P" not in data:
        return {}
    return {"cutting": {"F": data["P"]} | ({"free": data["k"]} if "k" in data else {})}


OWN = {
    "engine-v": _engine_v,
    "four-bar": _four_bar,
    "lever-six-bar": _lever,
    "scotch-yoke": _working_force,
    "shaper": _shaper,
    "slider-crank": _working_force,
    "slotted-lever": _slotted,
    "toggle-press": _toggle,
}


# --- a declared linkage -------------------------------------------------------------------------------


def _name(point: str) -> str:
    return point.replace("_", "")


def _linkage(task: Task, data: Mapping[str, str]) -> File:
    guides = {row[0]: row for row in task.table("Guides")[1:]}
    file: File = {
        "frame": {_name(row[0]): [typed(row[1]), typed(row[2])] for row in task.table("Fixed points")[1:]},
        "driver": _driver(task, data, guides),
        "groups": [_group(row, data, guides, task) for row in task.table("Groups")[1:]],
    }
    points = task.table("Further points")[1:]
    file["points"] = {_name(row[0]): {"link": row[1], "at": [typed(row[4]), typed(row[5])]} for row in points}
    centres = re.findall(r"(\w+) of link (\d+)[.,]", task.find(r"Mass centres: (.*)") or "")
    file["masses"] = [_body(_name(centre), link, data) for centre, link in centres]
    file["loads"] = list(_loads(task))
    if "g" in data:
        file["g"] = data["g"]
    if "δ_ω" in data:
        file["flywheel"] = {"delta": data["δ_ω"]}
    file |= _motion(task, data)
    if "their cycle takes two turns" in task.text:
        file["turns"] = "2"
    return file | _beside(task)


def _driver(task: Task, data: Mapping[str, str], guides: Mapping[str, Sequence[str]]) -> File:
    if centre := task.find(r"turns \w+ about the fixed point (\w+)"):
        arm = next(symbol for symbol in data if symbol.startswith(f"l_{centre}"))
        pin = arm.removeprefix(f"l_{centre}")
        speed = {COMMON[symbol]: data[symbol] for symbol in ("n", "ω_1") if symbol in data}
        if "ε_1" in data:
            speed["epsilon1"] = _accelerates(task, data["ε_1"])
        return {"type": "crank", "centre": _name(centre), "pin": pin, "length": data[arm]} | speed
    start = re.search(r"pin (\w+) stands (\S+) mm.* along .* link 1 moves (in|against)", task.text)
    assert start is not None
    begin = float(typed(task.find(r"its first position being at (\S+) mm") or start[2]))
    span = 1e3 * float(data["H_1"].split()[0])
    end = begin + (span if start[3] == "in" else -span)
    speed = {"speed": data[f"v_{start[1]}"]}
    if f"a_{start[1]}" in data:
        speed["acceleration"] = _accelerates(task, data[f"a_{start[1]}"])
    ends = {"start": f"{begin} mm", "end": f"{end:.10g} mm"}
    return {"type": "slider", "pin": start[1], "guide": _guide(guides["1"])} | speed | ends


def _guide(row: Sequence[str]) -> File:
    return {"on": row[1], "at": [typed(row[2]), typed(row[3])], "angle": typed(row[4])}


def _group(row: Sequence[str], data: Mapping[str, str], guides: Mapping[str, Sequence[str]], task: Task) -> File:
    """A group by its row; lengths by the names of its joints."""
    links, kind, joints = row[0].split(", "), row[1], [_name(one) for one in row[2].split(", ")]
    group: File = {"type": kind, "links": links, "joints": joints}
    match kind:
        case "RRR":
            first, middle, last = joints
            group["lengths"] = [data[f"l_{first}{middle}"], data[f"l_{last}{middle}"]]
            group["side"] = "left" if "to the left" in row[3] else "right"
        case "RRP":
            group |= {"length": data[f"l_{''.join(joints)}"], "guide": _guide(guides[links[1]])}
            group["end"] = "near" if "less far" in row[3] else "far"
        case "RPR":
            group["axis"] = "away" if "away" in row[3] else "towards"
            if offset := task.find(
                rf"The line of the slot of link {links[1]} passes .*? at a distance of ([^.]*\S mm)"
            ):
                group["offset"] = typed(offset)
        case "PRP":
            group["guides"] = [_guide(guides[link]) for link in links]
        case "RPP":
            group["guide"] = _guide(guides[links[1]])
            if across := task.find(rf"to the guide of link {links[1]} by (\S+°)"):
                group["across"] = typed(across)
    return group


def _body(centre: str, link: str, data: Mapping[str, str]) -> File:
    own = {letter: data[f"{letter}_{link}"] for letter in "Gm" if f"{letter}_{link}" in data}
    moment = next((data[symbol] for symbol in (f"J_{centre}", f"J_{centre}{link}") if symbol in data), None)
    return {"link": link, "at": centre} | own | ({"J": moment} if moment else {})


def _loads(task: Task) -> list[File]:
    found = []
    for line in re.findall(r"^[PM]_\d+\w*: .*$", task.text, re.MULTILINE):
        symbol, _, words = line.partition(": ")
        link = re.search(r"(?:link|slider|piston) (\d+)", words)
        assert link is not None
        load: File = {"link": link[1]}
        if at := re.search(r"at (\w+), at (\S+°)", words):
            load |= {"at": _name(at[1]), "direction": typed(at[2])}
        size = re.search(r"a (?:force|torque) of (.*?) on link", words)
        rows = task.table(f"Values of the load on link {link[1]}")
        if size:
            load |= {"by": "constant", "F" if symbol[0] == "P" else "M": typed(size[1])}
            load |= {"against": "motion"} if "always against" in words else {}
        elif "along its guide" in words:
            load |= _force_table(rows)
        else:
            (across, over), (_, values) = _columns(rows).items()
            unit = {"unit": "N"} if symbol[0] == "P" else {"torque_unit": "N m"}
            by = {"by": "way", "way": [f"{one} mm" for one in over]}
            if across == "φ":
                by = {"by": "angle", "angle": [f"{one} deg" for one in over]}
            load |= by | unit | {"values": values}
        found.append(load)
    return found
