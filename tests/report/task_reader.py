"""Reads the printed task of a machine, in English, and writes the assignment that it states.

It knows the words of a task and the keys of a file, and nothing of the program: whoever has the paper has as much.
"""

from __future__ import annotations

import re
from collections.abc import Mapping

from tests.report.linkage_task_reader import linkage_file
from tests.report.printed_task import COMMON, File, Task, diagram, force_table, rows_by_name, typed
from tests.report.task_additions import acceleration, additions, balancing, declared_loads, drive_motion

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


def file_of(kind: str, text: str) -> File:
    """The assignment that a printed task states."""
    task = Task.of(text)
    data = task.data
    file: File = {"kind": kind, "positions": _positions(task)}
    if kind == "linkage":
        return file | {"parameters": linkage_file(task, data)}
    symbols = COMMON | LENGTHS[kind]
    parameters: File = {symbols[symbol]: value for symbol, value in data.items() if symbol in symbols}
    for symbol, value in data.items():
        if found := re.fullmatch(r"([Gm])_(\d)|(s)_(\d)|(J)_S?([1-9]\d?)", symbol):
            letter, link = (part for part in found.groups() if part)
            parameters[letter + link] = value
    parameters |= _found(kind, task, data)
    if "δ_ω" in data:
        parameters["flywheel"] = {"delta": data["δ_ω"]}
    parameters |= drive_motion(task, data)
    parameters |= OWN.get(kind, lambda task, data: {})(task, data) | _further(task, data) | balancing(task, data)
    file["parameters"] = parameters
    if rows := task.table("Indicator diagram"):
        file["indicator"] = diagram(rows)
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


def _further(task: Task, data: Mapping[str, str]) -> File:
    """The acceleration of the crank, further loads, and what every machine may have."""
    found: File = {}
    if "ε_1" in data:
        found["epsilon1"] = acceleration(task, data["ε_1"])
    if "oads act on the links" in task.text:
        found["loads"] = declared_loads(task)
    return found | additions(task)


# --- what is a kind's own -----------------------------------------------------------------------------


def _working_force(task: Task, data: Mapping[str, str]) -> File:
    """A constant force with its stroke, or a table."""
    if "P" in data:
        way = task.find(r"acts only on the way (inward|outward)") or "both"
        return {"force": {"by": "constant", "F": data["P"], "stroke": way}}
    rows = task.table("Working force")
    return {"force": force_table(rows)} if rows else {}


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
        values = rows_by_name(rows)
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
