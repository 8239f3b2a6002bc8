"""Reads the printed task of an exercise of plane motion, in English, and writes the assignment that it states.

It knows the words of a task and the keys of a file, and nothing of the program: whoever has the paper has as much.
"""

from __future__ import annotations

import re
from typing import Any

from tests.report.printed_task import Task, typed

File = dict[str, Any]
GREEK = {"ω": "omega", "ε": "epsilon"}
BODY = r"(the ground|body \d+)"


def file_of(text: str) -> File:
    """The assignment that a printed exercise states."""
    task = Task.of(text)
    parameters: File = {"symbols": _symbols(task), "points": _points(task), "bodies": _bodies(task)}
    parameters |= {"joints": _joints(task), "given": _given(task), "find": _find(task)}
    return {"kind": "plane-motion", "parameters": {key: value for key, value in parameters.items() if value}}


def formula(text: str) -> str:
    """A printed formula or quantity as a file has it: r_1 + 2·r_2 → r1 + 2*r2, 0.5 m/s² → 0.5 m/s2."""
    if text == "0":
        return "0 mm"
    if re.match(r"[−\d.]+ ?[a-z°]", text):
        return typed(text)
    plain = text.replace("−", "-").replace("·", "*").replace("_", "").replace("√", "sqrt")
    plain = plain.replace("²", "^2").replace("³", "^3")
    for letter, name in GREEK.items():
        plain = plain.replace(letter, name)
    return plain


def _name(point: str) -> str:
    return point.replace("_", "")


def _symbols(task: Task) -> File:
    told = re.search(r"values of the symbols are (.*)\.$", task.text, re.MULTILINE)
    drawn = re.search(r"the figure and the answer sheet are for (.*)\.$", task.text, re.MULTILINE)
    found = told or drawn
    if found is None:
        return {}
    pairs = [one.split(" = ") for one in found[1].split(", ")]
    values = {formula(name): typed(value) for name, value in pairs}
    return values if told else {name: {"drawn": value} for name, value in values.items()}


def _points(task: Task) -> File:
    head, *rows = task.table("Coordinates of the points")
    unit = " mm" if "mm" in head[1] else ""
    return {_name(name): {"at": [formula(x + unit), formula(y + unit)]} for name, x, y in rows}


def _number(body: str) -> str:
    return "0" if body == "the ground" else body.removeprefix("body ")


def _bodies(task: Task) -> File:
    found: File = {}
    for name, words in re.findall(rf"^{BODY}: (.*)[;.]$", task.text, re.MULTILINE):
        disc = re.search(r"a disc with the centre (\w+) and the radius (.*)$", words)
        points = [_name(one) for one in re.split(r", | and ", words.partition("a disc")[0].strip(", ")) if one]
        found[_number(name)] = ({"points": points} if points else {}) | (
            {"disc": {"centre": _name(disc[1]), "radius": formula(disc[2])}} if disc else {}
        )
    return found


def _direction(words: str) -> File:
    if angle := re.search(r"at (\S+°) to the \+x axis", words):
        return {"angle": typed(angle[1])}
    ends = re.search(r"along ([A-Z](?:_\d+)?)([A-Z](?:_\d+)?)", words)
    assert ends is not None, words
    return {"along": [_name(ends[1]), _name(ends[2])]}


def _joints(task: Task) -> list[File]:
    found: list[File] = []
    for line in task.text.partition("What joins them:")[2].splitlines():
        pair = [_number(one) for one in re.findall(BODY, line)]
        if at := re.match(r"a pin at (\w+) joins", line):
            found.append({"type": "pin", "at": _name(at[1]), "bodies": pair})
        elif point := re.match(r"(\w+) of body \d+ moves along a straight line", line):
            slot = {"type": "slot", "point": _name(point[1]), "body": pair[0], "on": pair[1]}
            found.append(slot | _direction(line))
        elif "slides along a straight guide" in line:
            found.append({"type": "slider", "body": pair[0], "on": pair[1]} | _direction(line))
        elif "does not turn" in line:
            found.append({"type": "translation", "body": pair[0]})
        elif through := re.search(r"on a straight line of .* through (\w+)", line):
            rolling = {"type": "rolling on line", "disc": pair[0], "on": pair[1], "through": _name(through[1])}
            found.append(rolling | _direction(line))
        elif "roll on each other" in line:
            found.append({"type": "gears" if "as gears do" in line else "rolling on circle", "discs": pair})
        elif "belt" in line:
            found.append({"type": "belt", "discs": pair, "crossed": "true" if "a crossed belt" in line else "false"})
        elif ends := re.match(r"(\w+) and (\w+) keep their distance", line):
            found.append({"type": "cord", "points": [_name(ends[1]), _name(ends[2])]})
    return found


def _given(task: Task) -> list[File]:
    found: list[File] = []
    for line in task.text.partition("Given are:")[2].partition("To be found")[0].splitlines():
        rest = line.rstrip(";.")
        value = formula(rest.split(" = ")[1].split(", ")[0]) if " = " in rest else ""
        if told := re.match(r"the angular (velocity|acceleration) of body (\d+): .*, (anticlockwise|clockwise)", rest):
            kind = "omega" if told[1] == "velocity" else "epsilon"
            found.append({"type": kind, "body": told[2], "value": f"-{value}" if told[3] == "clockwise" else value})
        elif told := re.match(r"body (\d+) (does not turn|turns uniformly)", rest):
            found.append({"type": "omega" if "not" in told[2] else "epsilon", "body": told[1], "value": value})
        elif told := re.match(r"the (velocity|acceleration) of (\w+): .* at (\S+°) to the \+x axis", rest):
            found.append({"type": told[1], "point": _name(told[2]), "size": value, "direction": typed(told[3])})
        elif told := re.match(r"the line along which (\w+) moves, at (\S+°)", rest):
            found.append({"type": "velocity", "point": _name(told[1]), "direction": typed(told[2])})
        elif told := re.match(r"the line of the acceleration of (\w+), at (\S+°)", rest):
            found.append({"type": "acceleration", "point": _name(told[1]), "direction": typed(told[2])})
        elif told := re.match(r"(\w+) has moved from rest .*, at (\S+°) to the \+x axis, for t = (.*)", rest):
            rest_of = {"acceleration": value, "direction": typed(told[2]), "time": typed(told[3])}
            found.append({"type": "from rest", "point": _name(told[1])} | rest_of)
    return found


def _find(task: Task) -> list[str]:
    """What is asked; an instant centre that is a named point is told by that, whosever it is."""
    asked = task.find(r"To be found: (.*)\.")
    assert asked is not None
    letters = {"v": "v", "a": "a", "ω": "omega", "ε": "eps", "P": "centre"}
    pairs = [one.partition("_")[::2] for one in asked.split(", ")]
    return [f"{letters[letter]}.{of}" for letter, of in pairs if letter in letters and (letter != "P" or of.isdigit())]
