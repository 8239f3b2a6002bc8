"""Reads the printed task of a declared linkage."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

from tests.report.printed_task import COMMON, File, Task, point_name, typed
from tests.report.task_additions import acceleration, additions, declared_loads, drive_motion


def linkage_file(task: Task, data: Mapping[str, str]) -> File:
    """The parameters of a linkage that a printed task states."""
    guides = {row[0]: row for row in task.table("Guides")[1:]}
    file: File = {
        "frame": {point_name(row[0]): [typed(row[1]), typed(row[2])] for row in task.table("Fixed points")[1:]},
        "driver": _driver(task, data, guides),
        "groups": [_group(row, data, guides, task) for row in task.table("Groups")[1:]],
    }
    points = task.table("Further points")[1:]
    file["points"] = {point_name(row[0]): {"link": row[1], "at": [typed(row[4]), typed(row[5])]} for row in points}
    centres = re.findall(r"(\w+) of link (\d+)[.,]", task.find(r"Mass centres: (.*)") or "")
    file["masses"] = [_body(point_name(centre), link, data) for centre, link in centres]
    file["loads"] = list(declared_loads(task))
    if "g" in data:
        file["g"] = data["g"]
    if "δ_ω" in data:
        file["flywheel"] = {"delta": data["δ_ω"]}
    file |= drive_motion(task, data)
    if "their cycle takes two turns" in task.text:
        file["turns"] = "2"
    return file | additions(task)


def _driver(task: Task, data: Mapping[str, str], guides: Mapping[str, Sequence[str]]) -> File:
    if centre := task.find(r"turns \w+ about the fixed point (\w+)"):
        arm = next(symbol for symbol in data if symbol.startswith(f"l_{centre}"))
        pin = arm.removeprefix(f"l_{centre}")
        speed = {COMMON[symbol]: data[symbol] for symbol in ("n", "ω_1") if symbol in data}
        if "ε_1" in data:
            speed["epsilon1"] = acceleration(task, data["ε_1"])
        return {"type": "crank", "centre": point_name(centre), "pin": pin, "length": data[arm]} | speed
    start = re.search(r"pin (\w+) stands (\S+) mm.* along .* link 1 moves (in|against)", task.text)
    assert start is not None
    begin = float(typed(task.find(r"its first position being at (\S+) mm") or start[2]))
    span = 1e3 * float(data["H_1"].split()[0])
    end = begin + (span if start[3] == "in" else -span)
    speed = {"speed": data[f"v_{start[1]}"]}
    if f"a_{start[1]}" in data:
        speed["acceleration"] = acceleration(task, data[f"a_{start[1]}"])
    ends = {"start": f"{begin} mm", "end": f"{end:.10g} mm"}
    return {"type": "slider", "pin": start[1], "guide": _guide(guides["1"])} | speed | ends


def _guide(row: Sequence[str]) -> File:
    return {"on": row[1], "at": [typed(row[2]), typed(row[3])], "angle": typed(row[4])}


def _group(row: Sequence[str], data: Mapping[str, str], guides: Mapping[str, Sequence[str]], task: Task) -> File:
    """A group by its row; lengths by the names of its joints."""
    links, kind, joints = row[0].split(", "), row[1], [point_name(one) for one in row[2].split(", ")]
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
