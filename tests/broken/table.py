"""All wrong files: a right one of `files/`, what is changed in it, its faults where they stand.

In what is replaced, … at the end stands for all to the end of the file; in what takes its place, for what was there.
"""

from __future__ import annotations

from typing import Any

RIGHT = ""
"""No fault."""

GAS = "by: gas, link: 5, D: 9 cm, diagram: {unit: bar, by: crank_angle, angle: [0 deg, 720 deg], p: [1, 1]}}"
SLOPING = "{at: [-48 mm, 64 mm], angle: 36.86989764584402 deg}}\n"
LEVEL = "{at: [0 mm, 90 mm], angle: 0 deg}}\n"
TWO_GUIDES = "[{at: [0 mm, 9 mm], on: 1}, {angle: 33.3 deg}]}\n"
ROD = {
    "{at: [0 m, 3 m]}": "{at: [3 m, 1 m]}",
    "    - {type: pin, at: E, bodies: [0, 2]}\n    - {type: gears, discs: [1, 2]}\n": (
        "    - {type: rolling on line, disc: 2, through: D, angle: 0 deg}\n    - {type: cord, points: [C, E]}\n"
    ),
}
"""Two wheels on the ground with a rod between their centres."""

CHANGED: dict[str, list[tuple[Any, ...]]] = {
    "engine-twin": [
        # keys
        ("unknown key", {"  H: 95 mm": "…\n  speed: 3"}, "5:3 unknown-key"),
        ("unknown section", {"kind: engine-twin": "…\nsize: 3"}, "2:1 unknown-key"),
        ("unknown key without value", {"  H: 95 mm": "…\n  speed:"}, "5:3 unknown-key"),
        ("unknown section without value", {"kind: engine-twin": "…\nsize:"}, "2:1 unknown-key"),
        ("section without value", {"indicator:…": "indicator:"}, "11:1 missing-key"),
        ("form of the table without value", {"by: stroke": "by:"}, "13:3 choice"),
        ("unknown key in a row of keys", {"{language: en}": "{language: en, tittle: x}"}, "2:24 unknown-key"),
        ("unknown key two levels down", {"{language: en}": "{student: {nmae: x}}"}, "2:20 unknown-key"),
        ("unknown key of the indicator", {"  by: stroke": "…\n  p: [1]"}, "14:3 unknown-key"),
        ("merge key", {"parameters:": "…\n  <<: {H: 1 m}"}, "4:3 unknown-key"),
        ("duplicate key", {"  D: 98 mm": "…\n  H: 80 mm"}, "8:3 duplicate-key"),
        ("duplicate section", {"indicator:": "report:\n…"}, "11:1 duplicate-key"),
        ("missing key", {"  D: 98 mm\n": ""}, "3:1 missing-key"),
        ("key without value", {"  D: 98 mm": "  D:"}, "7:3 missing-key"),
        ("missing section", {"indicator:…": ""}, "1:1 missing-key"),
        ("missing kind", {"kind: engine-twin\n": ""}, "1:1 missing-key"),
        ("missing row", {"  exhaust: [1, 1, 3.6]\n": ""}, "11:1 missing-key"),
        ("missing form of the table", {"  by: stroke\n": ""}, "11:1 missing-key"),
        ("missing speed", {"  n: 2200 rpm\n": ""}, "3:1 missing-key"),
        ("missing weight", {"  G2: 20 N\n": ""}, "3:1 missing-key"),
        ("list as key", {"parameters:": "…\n  ? [a]\n  : 1"}, "4:5 wrong-type"),
        # units and numbers
        ("missing unit", {"H: 95 mm": "H: 95"}, "4:6 missing-unit"),
        ("wrong unit", {"H: 95 mm": "H: 95 kg"}, "4:6 wrong-unit"),
        ("unknown unit", {"H: 95 mm": "H: 95 parsnip"}, "4:6 unknown-unit"),
        ("frequency for a speed", {"2200 rpm": "36 Hz"}, "6:6 wrong-unit"),
        ("mass for a weight", {"20 N": "2 kg"}, "9:7 wrong-unit"),
        ("angle without unit", {"  s: 0.35": "…\n  crank_angle: 180"}, "9:16 missing-unit"),
        ("unit in a ratio", {"s: 0.35": "s: 0.35 mm"}, "8:6 unexpected-unit"),
        ("unit in a table", {"[1, 1, 3.6]": "[1, 1 bar, 3.6]"}, "18:16 unexpected-unit"),
        ("decimal comma", {"s: 0.35": "s: 0,35"}, "8:6 decimal-comma"),
        ("decimal comma with unit", {"H: 95 mm": "H: 95,5 mm"}, "4:6 decimal-comma", "write 95.5 mm"),
        ("comma of either kind", {"20 N": "1,600 N"}, "9:7 decimal-comma", "write 1.6 N or 1600 N"),
        ("comma before three decimals", {"20 N": "1,375 N"}, "9:7 decimal-comma", "write 1.375 N"),
        ("commas before thousands", {"20 N": "1,400,000 N"}, "9:7 decimal-comma", "write 1400000 N"),
        ("points before thousands", {"20 N": "1.400.000 N"}, "9:7 not-a-number", "write 1400000 N"),
        ("thousands and decimals", {"20 N": "1.400,5 N"}, "9:7 decimal-comma", "write 1400.5 N"),
        ("points of a date", {"20 N": "12.34.5 N"}, "9:7 not-a-number"),
        ("no number", {"H: 95 mm": "H: about 95 mm"}, "4:6 not-a-number"),
        ("no number in a table", {"[1, 1, 3.6]": "[1, x, 3.6]"}, "18:16 not-a-number"),
        ("empty item", {"[1, 1, 3.6]": "[1, ~, 3.6]"}, "18:16 wrong-type"),
        ("nan", {"s: 0.35": "s: .nan"}, "8:6 not-finite"),
        ("inf", {"H: 95 mm": "H: .inf mm"}, "4:6 not-finite"),
        ("inf in a table", {"[1, 1, 3.6]": "[1, -.inf, 3.6]"}, "18:16 not-finite"),
        ("beyond a float", {"H: 95 mm": "H: 1e999 mm"}, "4:6 not-finite"),
        ("division by zero", {"1/3.6": "1/0"}, "5:11 not-finite"),
        ("endless digits", {"s: 0.35": "s: " + "9" * 5000}, "8:6 not-a-number"),
        # ranges
        ("inverse ratio", {"1/3.6": "3.6"}, "5:11 out-of-range"),
        ("ratio of one", {"1/3.6": "1"}, "5:11 out-of-range"),
        ("negative length", {"H: 95 mm": "H: -95 mm"}, "4:6 out-of-range"),
        ("no length", {"D: 98 mm": "D: 0 mm"}, "7:6 out-of-range"),
        ("length of a street", {"H: 95 mm": "H: 1e300 mm"}, "4:6 out-of-range"),
        ("standing engine", {"2200 rpm": "0 rpm"}, "6:6 out-of-range"),
        ("mass centre beyond the rod", {"s: 0.35": "s: 1.1"}, "8:6 out-of-range"),
        ("absurd pressure", {"[1, 1, 3.6]": "[1, 1e300, 3.6]"}, "18:16 out-of-range"),
        ("fraction above one", {"[0, 0.5, 1]": "[0, 0.5, 1.5]"}, "14:15 out-of-range"),
        ("too few positions", {"{language: en}": "{}\npositions: {count: 3}"}, "3:20 out-of-range"),
        ("too many positions", {"{language: en}": "{}\npositions: {count: 361}"}, "3:20 out-of-range"),
        ("half a position", {"{language: en}": "{}\npositions: {count: 8.5}"}, "3:20 wrong-type"),
        ("drawing beyond the paper", {"{language: en}": "{}\ndrawing: {crank: 5 m}"}, "3:18 out-of-range"),
        # kinds of value
        ("unknown kind", {"engine-twin": "engine-twins"}, "1:7 unknown-kind"),
        ("kind as a list", {"engine-twin": "[engine-twin]"}, "1:7 wrong-type"),
        ("section as text", {"indicator:…": "indicator: none"}, "11:12 wrong-type"),
        ("report as a list", {"{language: en}": "[en]"}, "2:9 wrong-type"),
        ("text as a section", {"{language: en}": "{place: {a: b}}"}, "2:17 wrong-type"),
        ("quantity as a list", {"H: 95 mm": "H: [95, mm]"}, "4:6 wrong-type"),
        ("row as a number", {"[1, 1, 3.6]": "3"}, "18:12 wrong-type"),
        ("another language", {"language: en": "language: fr"}, "2:20 choice"),
        ("another direction", {"{language: en}": "{}\npositions: {direction: left}"}, "3:24 choice"),
        ("another form of the table", {"by: stroke": "by: hand"}, "13:7 choice"),
        ("another reference", {"  by: stroke": "…\n  reference: vacuum"}, "14:14 choice"),
        ("no date", {"language: en": "date: 24/3/2011"}, "2:16 date"),
        ("no such day", {"language: en": "date: 2011-02-30"}, "2:16 date"),
        ("control character in a name", {"language: en": 'place: "\\a"'}, "2:17 control-character"),
        ("line break in a name", {"language: en": 'place: "a\\nb"'}, "2:17 control-character"),
        ("half a surrogate in a name", {"language: en": 'place: "\\ud800"'}, "2:17 control-character"),
        ("endless name", {"language: en": "place: " + "x" * 301}, "2:17 text-too-long"),
        # positions written out
        ("position after the cycle", {"language: en": "worked_positions: [4, 17]"}, "2:32 no-such-position"),
        ("position zero", {"language: en": "worked_positions: [0]"}, "2:28 out-of-range"),
        ("position twice", {"language: en": "worked_positions: [4, 4]"}, "2:28 repeated"),
        ("no position at all", {"language: en": "worked_positions: []"}, "2:28 too-few"),
        ("positions in words", {"language: en": "worked_positions: some"}, "2:28 wrong-type"),
        # pairs and tables
        ("speed twice", {"  n: 2200 rpm": "…\n  omega1: 230 rad/s"}, "7:3 both-given"),
        ("weight and mass", {"  G2: 20 N": "  m2: 2 kg\n…"}, "10:3 both-given"),
        ("second weight and mass", {"  G2: 20 N": "…\n  G4: 1 N\n  m4: 1 kg"}, "11:3 both-given"),
        ("short row", {"[1, 1, 3.6]": "[1, 3.6]"}, "18:12 row-length"),
        ("long row", {"[1, 1, 3.6]": "[1, 1, 1, 3.6]"}, "18:12 row-length"),
        ("row of one", {"[1, 1, 3.6]": "[1]"}, "18:12 too-few"),
        ("unordered s", {"[0, 0.5, 1]": "[0, 1, 0.5]"}, "14:13 not-increasing"),
        ("repeated s", {"[0, 0.5, 1]": "[0, 0, 1]"}, "14:10 not-increasing"),
        (
            "comma in a list",
            {"[0, 0.5, 1]": "[0, 0,5, 1]"},
            "14:6 row-length, 14:10 not-increasing, 14:12 out-of-range",
        ),
        ("table begins late", {"[0, 0.5, 1]": "[0.1, 0.5, 1]"}, "14:7 table-end"),
        ("table ends early", {"[0, 0.5, 1]": "[0, 0.5, 0.9]"}, "14:15 table-end"),
        ("impossible firing", {"  by: stroke": "…\n  firing: [intake, intake]"}, "14:11 firing"),
        ("unknown stroke", {"  by: stroke": "…\n  firing: [intake, idle]"}, "14:20 choice"),
        ("three in a firing pair", {"  by: stroke": "…\n  firing: [intake, intake, intake]"}, "14:11 too-many"),
        ("half a firing pair", {"  by: stroke": "…\n  firing: [intake]"}, "14:11 too-few"),
        # YAML
        ("tab before a key", {"  H: 95 mm": "\tH: 95 mm"}, "4:1 tab"),
        ("tab after a key", {"  H: 95 mm": "  H:\t95 mm"}, "4:5 tab"),
        ("tab in a value", {"H: 95 mm": "H: 95\tmm"}, "4:8 tab"),
        ("tag", {"H: 95 mm": "H: !!python/object:os.system 95 mm"}, "4:6 tag"),
        ("local tag", {"H: 95 mm": "H: !x 95 mm"}, "4:6 tag"),
        ("anchor", {"H: 95 mm": "H: &a 95 mm"}, "4:6 alias"),
        ("alias", {"  G3: 22 N": "  G3: *a"}, "10:7 alias"),
        ("second colon", {"H: 95 mm": "H: 95: mm"}, "4:8 syntax"),
        ("open bracket", {"[1, 1, 3.6]": "[1, 1, 3.6"}, "19:1 syntax"),
        ("bracket closed twice", {"[1, 1, 3.6]": "[1, 1, 3.6]]"}, "18:23 syntax"),
        ("open quotation", {"language: en": "place: 'en"}, "19:1 syntax"),
        ("indentation", {"  H: 95 mm": "   H: 95 mm"}, "4:4 syntax"),
        ("second document", {"indicator:": "---\n…"}, "11:1 syntax"),
        (
            "many faults, told in the order of the file",
            {"95 mm": "95", "2200 rpm": "2,2 rpm", "G2": "Q2", "0.5, 1]": "1]"},
            "3:1 missing-key, 4:6 missing-unit, 6:6 decimal-comma, 9:3 unknown-key, 14:6 row-length",
        ),
        ("endless row", {"[1, 1, 3.6]": str([1] * 2001)}, "18:12 too-many"),
        ("no report", {"report: {language: en}\n": ""}, RIGHT),
    ],
    "engine-twin-by-angle": [
        ("angles out of order", {"0 deg, 720": "720 deg, 0"}, "14:20 not-increasing"),
        ("angles of one turn", {"720": "360"}, "14:18 table-end"),
        ("an angle without unit", {"0 deg, ": "0, "}, "14:11 missing-unit"),
        ("a pressure too many", {"[1, 1]": "[1, 1, 1]"}, "15:6 row-length"),
        ("a row of the other form", {"p: [1, 1]": "…\n  intake: [1, 1]"}, "16:3 unknown-key"),
    ],
    "engine-single": [
        ("faster down than up", {"K: 1.04": "K: 0.96"}, "6:6 out-of-range"),
        ("equal travel times beside an offset", {"K: 1.04": "K: 1"}, "6:6 out-of-range"),
        ("offset that no crank can have", {"e: 45 mm": "e: 3500 mm"}, "5:6 out-of-range"),
        ("no offset beside K", {"e: 45 mm": "e: 0 mm"}, "5:6 out-of-range"),
        ("no travel times", {"  K: 1.04\n": ""}, "3:1 missing-key"),
        ("lengths twice", {"K: 1.04": "…\n  R: 107 mm\n  L: 411 mm"}, "4:3 both-given"),
        ("crank without rod", {"  H: 215 mm\n  e: 45 mm\n  K: 1.04": "  R: 107 mm"}, "3:1 missing-key"),
        (
            "rod shorter than crank and offset",
            {"  H: 215 mm\n  e: 45 mm\n  K: 1.04": "  R: 107 mm\n  e: 45 mm\n  L: 150 mm"},
            "6:6 out-of-range",
        ),
        ("gyration and moment", {"G3: 200 N": "…\n  rho: 0.16\n  J2: 1 kg m2"}, "13:3 both-given"),
        ("heights without angles", {"[0, 140, 0]": "[0, 140]"}, "16:11 row-length"),
        ("scale without unit", {"scale: 2 N/cm2": "scale: 2"}, "14:10 missing-unit"),
        ("pressures for heights", {"  height:": "  p:"}, "12:1 missing-key, 16:3 unknown-key"),
        ("firing of one cylinder", {"  by: ordinates": "…\n  firing: [intake, exhaust]"}, "14:3 unknown-key"),
        (
            "position after the cycle",
            {"parameters:": "report: {worked_positions: [30, 31]}\n…"},
            "3:33 no-such-position",
        ),
    ],
    "engine-v": [
        ("flywheel without loads", {"PC: 1 kN": "flywheel: {delta: 1/50}"}, "2:102 flywheel-without-loads"),
        ("articulation beyond the rod", {"BD: 66 mm": "BD: 260 mm"}, "2:41 out-of-range"),
        ("rod too short", {"BC: 253 mm": "BC: 80 mm"}, "2:29 no-assembly"),
        # A rod articulated far out on a short main rod follows the eight that its end goes through.
        (
            "four strokes in a turn",
            {"BC: 253 mm, BD: 66 mm, DE: 196 mm": "BC: 187 mm, BD: 155 mm, DE: 223 mm", "beta: 70 deg": "beta: 1 deg"},
            "2:53 not-to-and-fro",
        ),
        ("bore without diagram", {"PC: 1 kN": "D: 80 mm"}, "1:1 missing-key"),
        ("force and bore", {"PC: 1 kN": "…, D: 80 mm"}, "1:1 missing-key, 2:102 both-given"),
    ],
    "slider-crank": [
        ("rod shorter than crank and offset", {"l: 600 mm": "l: 190 mm"}, "4:6 out-of-range"),
        ("offset beyond the rod", {"e: 40 mm": "e: -450 mm"}, "4:6 out-of-range"),
        ("no crank", {"  r: 150 mm\n": ""}, "2:1 missing-key"),
        ("speed twice", {"n: 300 rpm": "…\n  omega1: 31 rad/s"}, "7:3 both-given"),
        ("weight and mass", {"G2: 40 N": "…\n  m2: 4 kg"}, "8:3 both-given"),
        ("form of the force", {"by: stroke": "by: hand"}, "9:9 choice"),
        ("no form of the force", {"    by: stroke\n": ""}, "8:3 missing-key"),
        ("force in kilograms", {"unit: N": "unit: kg"}, "10:11 wrong-unit"),
        ("short row of forces", {"[0, 1, 2]": "[0, 1]"}, "12:13 row-length"),
        ("fractions that fall", {"[0, 0.5, 1]": "[0, 1, 0.5]"}, "11:15 not-increasing"),
        ("table ends early", {"[0, 0.5, 1]": "[0, 0.5, 0.9]"}, "11:17 table-end"),
        ("row of the other form", {"    unit: N": "…\n    F: [1, 2]"}, "11:5 unknown-key"),
        ("an indicator", {"kind: slider-crank": "…\nindicator: {}"}, "2:1 unknown-key"),
        ("stroke of no name", {"    by:…": "    by: constant\n    F: 5 N\n    stroke: up\n"}, "11:13 choice"),
        (
            "angles of two turns",
            {"    by:…": "    by: crank_angle\n    unit: N\n    angle: [0 deg, 720 deg]\n    F: [0, 1]\n"},
            "11:20 out-of-range",
        ),
        ("unevenness in words", {"e: 40 mm": "…\n  flywheel: {delta: small}"}, "6:21 not-a-number"),
        ("unevenness of 40", {"e: 40 mm": "…\n  flywheel: {delta: 40}"}, "6:21 out-of-range"),
        ("flywheel of nothing", {"e: 40 mm": "…\n  flywheel: {}"}, "6:3 missing-key"),
        (
            "motion without inertia",
            {"  G2: 40 N\n": "  m3: 2 kg\n  motion: {drive: {constant: find}}\n"},
            "8:3 motion-no-inertia",
        ),
        ("half a drive", {"e: 40 mm": "…\n  J1: 2 kg m2\n  motion: {drive: {M0: 90 N m}}"}, "7:19 missing-key", "k"),
        ("no drive", {"e: 40 mm": "…\n  J1: 2 kg m2\n  motion: {drive: {}}"}, "7:19 missing-key"),
        (
            "two drives",
            {"e: 40 mm": "…\n  J1: 2 kg m2\n  motion: {drive: {M0: 90 N m, k: 1 N m s, constant: find}}"},
            "7:44 both-given",
        ),
        (
            "a drive of no name",
            {"e: 40 mm": "…\n  J1: 2 kg m2\n  motion: {drive: {constant: found}, steady: false}"},
            "7:30 not-a-number, 7:46 choice",
        ),
        (
            "a drive that turns back",
            {"e: 40 mm": "…\n  J1: 2 kg m2\n  motion: {drive: {table: {n: [0 rpm, 9 rpm, 5 rpm], M: [1 N m, 1 N m]}}}"},
            "7:46 not-increasing, 7:57 row-length",
        ),
        (
            "a machine that runs away",
            {"e: 40 mm": "…\n  J1: 2 kg m2\n  motion: {drive: {constant: 500 N m}}"},
            "7:12 motion-runs-away",
            "500 N·m",
        ),
        (
            "a machine that runs down",
            {"e: 40 mm": "…\n  J1: 2 kg m2\n  motion: {drive: {M0: 0.001 N m, k: 1 N m s}}"},
            "7:12 motion-runs-down",
        ),
        (
            "a machine that stalls",
            {
                "inward: [0, 1, 2]": "inward: [0, 2000, 0]",
                "outward: [0, 0, 0]": "…\n  J1: 0.1 kg m2\n"
                "  motion: {drive: {kloss: {Mk: 60 N m, sk: 0.2, n0: 90 rpm}}}",
            },
            "15:12 motion-stalls",
            "is missing there",
        ),
        (
            "a machine that does not start",
            {"e: 40 mm": "…\n  J1: 2 kg m2\n  motion: {drive: {M0: 2 N m, k: 0.01 N m s}, start: {from: 0 deg}}"},
            "7:47 motion-does-not-start",
            "it would start from",
        ),
        (
            "a machine that does not stop",
            {"e: 40 mm": "…\n  J1: 2 kg m2\n  motion: {drive: {constant: find}, stop: {brake: 0.0001 N m}}"},
            "7:37 motion-does-not-stop",
        ),
        (
            "motion and an acceleration",
            {"e: 40 mm": "…\n  J1: 2 kg m2\n  epsilon1: 2 rad/s2\n  motion: {drive: {constant: find}}"},
            "8:3 motion-without-turn",
        ),
    ],
    "four-bar": [
        ("no speed", {"  omega1: 20 rad/s\n": ""}, "3:1 missing-key"),
        ("speed twice", {"omega1: 20 rad/s": "…\n  n: 9 rpm"}, "9:3 both-given"),
        ("weight and mass", {"BC: 340 mm": "…\n  G2: 3 N\n  m2: 1 kg"}, "7:3 both-given"),
        ("branch of no name", {"CD: 280 mm": "…\n  branch: upper"}, "7:11 choice"),
        ("half a coupler point", {"{along: 150 mm, across: 110 mm}": "{across: 110 mm}"}, "9:3 missing-key"),
        ("torque in newtons", {"M: 40 N m": "M: 40 N"}, "10:15 wrong-unit"),
        ("force without direction", {"torque: {M: 40 N m}": "force: {P: 40 N}"}, "10:3 missing-key"),
        ("an indicator", {"kind: four-bar": "…\nindicator: {}"}, "2:1 unknown-key"),
        # machines that do not go round
        # BD would be longer than BC + CD = 620 mm where 300² + 400² − 2·300·400 cos φ > 620².
        ("crank too long", {"AB: 120 mm": "AB: 300 mm"}, "5:7 no-assembly", "(2, 3)", "BC, CD", "-124.1°", "124.1°"),
        ("links too short", {"AD: 400 mm": "AD: 900 mm"}, "5:7 never-assembled"),
        # AB + AD = BC + CD: at 180° coupler and link 3 lie in one line.
        ("change point", {"BC: 340 mm": "BC: 240 mm"}, "5:7 dead-point", "180°"),
        ("no rocker", {"AB: 120 mm": "AB: 300 mm", "AD: 400 mm": "AD: 100 mm\n  link3: rocker"}, "8:10 not-a-rocker"),
        ("no crank", {"AD: 400 mm": "…\n  link3: crank"}, "8:10 not-a-crank"),
        # single instants, a crank that accelerates, a horizontal plane, loads on any link
        ("instants and a number", {"kind: four-bar": "…\npositions: {at: [50 deg], count: 8}"}, "2:27 both-given"),
        ("an instant twice", {"kind: four-bar": "…\npositions: {at: [50 deg, 50 deg]}"}, "2:26 repeated"),
        ("an instant in millimetres", {"kind: four-bar": "…\npositions: {at: [50 mm]}"}, "2:18 wrong-unit"),
        (
            "an instant out of reach",
            {"kind: four-bar": "…\npositions: {at: [50 deg, 180 deg]}", "AB: 120 mm": "AB: 300 mm"},
            "2:26 no-assembly-at",
            "180°",
        ),
        (
            "an instant at a dead point",
            {"kind: four-bar": "…\npositions: {at: [180 deg]}", "BC: 340 mm": "BC: 240 mm"},
            "2:18 dead-point-at",
        ),
        (
            "a flywheel at instants",
            {"kind: four-bar": "…\npositions: {at: [50 deg]}", "AB: 120 mm": "…\n  G2: 3 N\n  flywheel: {delta: 0.02}"},
            "7:3 flywheel-without-turn",
        ),
        (
            "a flywheel and an acceleration",
            {"AB: 120 mm": "…\n  G2: 3 N\n  epsilon1: 2 rad/s2\n  flywheel: {delta: 0.02}"},
            "7:3 flywheel-without-turn",
        ),
        ("gravity in a plane", {"AB: 120 mm": "…\n  plane: horizontal\n  g: 9.8 m/s2"}, "6:6 plane-with-gravity"),
        ("a weight without gravity", {"AB: 120 mm": "…\n  g: 0 m/s2\n  G2: 3 N"}, "6:3 weight-without-gravity", "m2"),
        ("a load on no link", {"AB: 120 mm": "…\n  loads: [{by: constant, link: 4, M: 2 N m}]"}, "5:32 no-such-link"),
        (
            "a spring without an end",
            {"AB: 120 mm": "…\n  springs: [{link: 3, at: C, c: 4 N/mm, free: 9 mm}]"},
            "5:13 missing-key",
        ),
        (
            "a spring to nowhere",
            {"AB: 120 mm": "…\n  springs: [{link: 3, at: C, to: X, c: 4 N/mm, free: 9 mm}]"},
            "5:34 no-such-point",
        ),
        (
            "a spring between points of one link",
            {"AB: 120 mm": "…\n  springs: [{link: 3, at: C, to: {link: 3, at: D}, c: 4 N/mm, free: 9 mm}]"},
            "5:34 spring-on-one-link",
        ),
        (
            "a spring about no pin",
            {"AB: 120 mm": "…\n  springs: [{link: 3, about: A, c: 4 N m/rad, free: 9 deg}]"},
            "5:30 no-such-pin",
        ),
        (
            "a torsion spring in newtons a millimetre",
            {"AB: 120 mm": "…\n  springs: [{link: 3, about: D, c: 4 N/mm, free: 9 deg}]"},
            "5:36 wrong-unit",
        ),
        (
            "an end that is none",
            {"AB: 120 mm": "…\n  springs: [{link: 3, at: C, to: [3 mm], c: 4 N/mm, free: 9 mm}]"},
            "5:34 spring-end",
        ),
        ("friction in no joint", {"AB: 120 mm": "…\n  friction: {pins: {X: {rho: 2 mm}}}"}, "5:21 no-such-joint"),
        ("a pin without radius", {"AB: 120 mm": "…\n  friction: {pins: {A: {f: 0.1}}}"}, "5:23 missing-key"),
        ("a circle and f", {"AB: 120 mm": "…\n  friction: {pins: {A: {f: 0.1, rho: 2 mm}}}"}, "5:25 both-given"),
        ("friction of no slider", {"AB: 120 mm": "…\n  friction: {sliders: {3: 0.1}}"}, "5:24 no-slider"),
        (
            "friction of nothing",
            {"AB: 120 mm": "…\n  friction: {pins: {A: {rho: 2 mm}}}", "  torque: {M: 40 N m}\n": ""},
            "5:3 friction-without-loads",
        ),
        (
            "friction that locks",
            {"AB: 120 mm": "…\n  friction: {pins: {B: {f: 0.9, r: 400 mm}, C: {f: 0.9, r: 400 mm}}}"},
            "5:3 locks",
        ),
        ("a face of no slider", {"AB: 120 mm": "…\n  faces: {3: {from: -1 mm, to: 2 mm}}"}, "5:11 no-slider"),
        (
            "a load at no point of its link",
            {"AB: 120 mm": "…\n  loads: [{by: constant, link: 3, at: B, F: 2 N}]"},
            "5:39 not-on-link",
        ),
    ],
    "lever-six-bar": [
        ("no fixed point", {"  D: {x: -10 mm, y: -106 mm}\n": ""}, "3:1 missing-key"),
        ("a coupler and a swing", {"AB: 34 mm": "swing: {angle: 60 deg, K: 1.05}"}, "5:3 both-given"),
        (
            "a swing that no links give",
            {"AB: 34 mm": "swing: {angle: 100 deg, K: 2.5}", "  AC: 90 mm\n": ""},
            "4:10 no-such-swing",
        ),
        ("E beyond A", {"CE: 30 mm": "CE: 95 mm"}, "7:7 out-of-range"),
        ("side of no name", {"CE: 30 mm": "…\n  F: above"}, "8:6 choice"),
        ("flywheel, no loads", {"CE: 30 mm": "…\n  flywheel: {delta: 0.1}"}, "8:3 flywheel-without-loads"),
        ("coupler too short", {"AC: 90 mm": "AC: 70 mm"}, "6:7 no-assembly"),
        ("rod too short", {"EF: 110 mm": "EF: 30 mm"}, "8:7 no-assembly"),
        ("guide out of reach", {"guide: -73 mm": "guide: 300 mm"}, "8:7 never-assembled"),
        (
            "rocker that is a crank",
            {
                "AB: 34 mm": "AB: 140 mm",
                "CD: 60 mm": "CD: 130 mm",
                "EF: 110 mm": "EF: 600 mm",
                "AC: 90 mm": "AC: 120 mm",
            },
            "6:7 not-a-rocker",
        ),
    ],
    "scotch-yoke": [
        ("no speed", {", n: 240 rpm": ""}, "3:1 missing-key"),
        ("negative crank", {"r: 50 mm": "r: -50 mm"}, "3:17 out-of-range"),
        ("flywheel without loads", {"240 rpm": "…, flywheel: {delta: 1/30}"}, "3:36 flywheel-without-loads"),
        (
            "long row",
            {"240 rpm": "…, force: {by: stroke, unit: N, s: [0, 1], inward: [1, 2, 3], outward: [0, 0]}"},
            "3:84 row-length",
        ),
    ],
    "toggle-press": [
        # |OB| would have to reach 300 mm at the least; the rod is too short at one end of the turn.
        ("links too short", {"AB: 232 mm, BD: 250 mm": "AB: 150 mm, BD: 150 mm"}, "3:29 never-assembled"),
        ("links too short at one end", {"AB: 232 mm, BD: 250 mm": "AB: 180 mm, BD: 180 mm"}, "3:29 no-assembly"),
        # D below the crank: the knee stands above D and the ram would stay in D.
        (
            "pivot below the crank",
            {"D: {x: -300 mm, y: 220 mm}, B: left": "D: {x: -200 mm, y: -200 mm}, B: right"},
            "3:80 out-of-range",
        ),
        # The toggle goes through its stretched position and presses twice in a turn.
        (
            "two strokes in a turn",
            {
                "AB: 232 mm": "AB: 260 mm",
                "B: left": "…, press: {unit: N, s: [0, 0.4, 0.8, 1], P: [0, 500, 1500, 4000]}",
            },
            "3:105 not-to-and-fro",
        ),
        ("long row", {"B: left": "…, press: {unit: N, s: [0, 1], P: [0, 1, 2]}"}, "3:129 row-length"),
        ("table ends early", {"B: left": "…, press: {unit: N, s: [0, 0.5], P: [0, 1]}"}, "3:122 table-end"),
    ],
    "linkage": [
        ("name of a point", {"E: {link: 3": "e1: {link: 3"}, "13:5 point-name"),
        ("unknown point", {"joints: [B, C, D]": "joints: [B, C, X]"}, "6:49 no-such-point"),
        ("point of a later group", {"joints: [B, C, D]": "joints: [F, C, D]"}, "6:43 not-placed"),
        ("point named twice", {"joints: [E, F]": "joints: [E, C]"}, "9:19 point-taken"),
        ("link numbered twice", {"links: [4, 5]": "links: [4, 3]"}, "8:18 link-taken, 19:26 no-slider"),
        ("crank's centre", {"centre: A": "centre: B"}, "4:33 no-such-point"),
        ("guide on a later link", {"angle: 0 deg}": "angle: 0 deg, on: 5}"}, "11:53 link-not-placed, 19:26 no-slider"),
        ("point on no link", {"{link: 3, at: [300": "{link: 8, at: [300"}, "9:16 not-placed, 13:15 no-such-link"),
        ("mass on another link", {"at: S2, G": "at: F, G"}, "16:21 not-on-link"),
        ("mass by nothing", {"at: S2, G: 30 N": "at: S2"}, "16:7 missing-key"),
        ("load on no slider", {"stroke, link: 5": "stroke, link: 3"}, "19:26 no-slider"),
        ("force and torque", {"M: 5 N m": "…, F: 3 N"}, "18:41 force-or-torque"),
        ("load without size", {"link: 3, M: 5 N m": "link: 3"}, "18:7 missing-key"),
        ("other degree of freedom", {"W: 1": "W: 2"}, "20:17 not-as-declared"),
        ("other class", {"class: 2": "class: 3"}, "20:27 not-as-declared"),
        ("other groups", {"[4, 5]]": "[4, 6]]"}, "20:38 not-as-declared"),
        ("speed twice", {"n: 60 rpm": "…, omega1: 6 rad/s"}, "4:71 both-given"),
        ("no speed", {", n: 60 rpm": ""}, "4:3 missing-key"),
        ("unknown key of a group", {"side: left": "…, hand: left"}, "6:92 unknown-key"),
        ("kind of group", {"type: RRP": "type: RRX"}, "7:13 choice"),
        (
            "gas in one turn",
            {"by: stroke, link: 5, unit: N, s: [0, 1], inward: [1, 1], outward: [0, 0]}": GAS},
            "19:12 gas-needs-two-turns",
        ),
        # By the triangle BCD: BD ≤ 340 + 150 fails where 120² + 400² − 2·120·400 cos φ > 490², beyond ±133.2°.
        ("does not assemble over a turn", {"280 mm]": "150 mm]"}, "6:7 no-assembly", "group (2, 3)", "BC, CD", "133.2"),
        ("never assembles", {"[340 mm, 280 mm]": "[34 mm, 28 mm]"}, "6:7 never-assembled"),
        ("toggle position", {"[340 mm, 280 mm]": "[300 mm, 220 mm]"}, "6:7 dead-point"),
        ("block leaves its slot", {"angle: 0 deg}": "angle: 0 deg, slot: [0 mm, 650 mm]}"}, "11:55 out-of-slot"),
    ],
    "linkage-slide": [
        ("angle of the start", {"count: 5": "…, start: 30 deg"}, "2:23 no-crank"),
        ("direction", {"count: 5": "…, direction: clockwise"}, "2:23 no-crank"),
        ("drawn crank", {"drawing: {}": "drawing: {crank: 40 mm}"}, "3:11 no-crank"),
        ("turns", {"  frame:": "  turns: 2\n…"}, "5:3 no-crank"),
        ("angles added", {"  frame:": "  also_at: [35 deg]\n…"}, "5:3 no-crank"),
        (
            "load over an angle",
            {"{by: way, …": "{by: angle, link: 5, at: F, unit: N, angle: [0 deg, 360 deg], values: [0, 5]}\n"},
            "17:12 needs-a-crank",
        ),
        ("key unknown to a load by way", {"unit: N": "…, units: N"}, "17:61 unknown-key"),
        (
            "way of a crank",
            {
                "type: slider": "type: crank, centre: A",
                "guide: {angle: 0 deg}, start: 0 mm, end: 120 mm, speed: 0.3 m/s": "length: 20 mm, n: 60 rpm",
            },
            "6:33 no-such-point, 17:12 needs-a-slide",
        ),
        ("end of the table", {"60 mm, 120 mm]": "60 mm, 100 mm]"}, "17:80 table-end"),
        ("order of the table", {"60 mm, 120 mm]": "60 mm, 50 mm]"}, "17:80 not-increasing"),
        ("a value too few", {"[0, 5, 9]": "[0, 5]"}, "17:97 row-length"),
        ("load without unit", {"unit: N, ": ""}, "17:7 missing-key"),
        ("torque at a point", {"unit: N,": "unit: N, torque_unit: N m,"}, "17:61 force-or-torque"),
        ("end of the driver's slot", {"{angle: 0 deg}": "{slot: [0 mm, 100 mm]}"}, "6:83 driver-out-of-slot"),
        ("start of the driver's slot", {"{angle: 0 deg}": "{slot: [1 mm, 120 mm]}"}, "6:72 driver-out-of-slot"),
        (
            "block leaves its slot",
            {"angle: 90 deg}": "angle: 90 deg, slot: [300 mm, 400 mm]}"},
            "13:56 out-of-slot-slide",
        ),
        # The lever turns with the clock, so F sinks: lowest at the end of the driver's way, 120 mm.
        (
            "block leaves its slot at the end",
            {"angle: 90 deg}": "angle: 90 deg, slot: [460 mm, 500 mm]}"},
            "13:56 out-of-slot-slide",
            "with link 1 at 120 mm",
        ),
        ("flywheel", {"parameters:\n": "parameters:\n  flywheel: {delta: 1/50}\n"}, "5:3 flywheel-of-slide"),
        ("motion", {"parameters:\n": "parameters:\n  motion: {drive: {constant: find}}\n"}, "5:3 motion-of-slide"),
    ],
    "dyad": [
        # The pin comes as near to D as the slot's offset: |AD| − |AB| = 100 − 40 = 60, the crank along AD.
        ("offset slot", {"59.9": "60"}, "7:7 dead-point", "(2, 3)", "53.13"),
        ("offset slot on the right", {"59.9": "-60"}, "7:7 dead-point", "(2, 3)", "53.13"),
        # |AB| = |AD|: the pin meets the pivot, and the lever has no direction.
        ("pin on the pivot", {"40 mm": "100 mm", "59.9": "0"}, "7:7 dead-point", "(2, 3)", "53.13"),
        # |BC| + |CD| = 65 + 75 = |AD| + |AB|: stretched, with the crank pointing away from D.
        (
            "rods stretched",
            {"type: RPR…": "type: RRR, links: [2, 3], joints: [B, C, D], lengths: [65 mm, 75 mm], side: left}\n"},
            "7:7 dead-point",
            "(2, 3)",
            "-126.9",
        ),
        # The guide passes A at 80 mm; the pin is 80 + 50 = 130 mm off it with the crank square to it, away from it.
        (
            "rod square to the guide",
            {
                "40 mm": "50 mm",
                "type: RPR…": "type: RRP, links: [2, 3], joints: [B, C], length: 130 mm, guide: " + SLOPING,
            },
            "7:7 dead-point",
            "(2, 3)",
            "-53.13",
        ),
        # A guide along the crank and one at 33.3°: parallel when the crank stands there or opposite.
        (
            "parallel guides",
            {"type: RPR…": "type: PRP, links: [2, 3], joints: [C], guides: " + TWO_GUIDES},
            "7:7 dead-point",
            "(2, 3)",
            "33.3",
        ),
        # Both slides along one line.
        (
            "slides in line",
            {"type: RPR…": "type: RPP, links: [2, 3], joints: [B, C], across: 0 deg, guide: " + LEVEL},
            "7:7 dead-point",
            "(2, 3)",
            "stands at",
        ),
        # 100² + 40² − 2·100·40 cos δ = 60.00005² at δ = 0.0702°: a gap between the samples.
        ("gap of an offset slot", {"59.9": "60.00005"}, "7:7 no-assembly", "(2, 3)", "53.06", "53.2"),
    ],
    "dyad-slide": [
        # D is 50 mm from the way, at 100.1 mm, and 150 − 100 = 50.
        ("rods folded along a way", {"149 mm": "150 mm"}, "7:7 dead-point-slide", "(2, 3)", "100.1 mm"),
        # 50² + x² = 50.0001² at x = ±0.1 mm.
        ("gap along a way", {"149 mm": "150.0001 mm"}, "7:7 no-assembly-slide", "100 ", "100.2"),
    ],
    "plane-motion": [
        ("point without a place", {"{at: [0 m, 0 m]}": "{}"}, "4:8 missing-key"),
        ("two places", {"O: {at: [0 m, 0 m]}": "O: {at: [0 m, 0 m], from: A}"}, "4:25 both-given"),
        ("distance without a way", {", angle: 45 deg": ""}, "5:8 missing-key"),
        ("later point", {"from: O": "from: B"}, "5:15 no-such-point"),
        ("unknown point of a body", {"2: {points: [A, B]}": "2: {points: [A, X, B]}"}, "9:21 no-such-point"),
        (
            "body without points",
            {"2: {points: [A, B]}": "2: {points: []}"},
            "9:8 missing-key, 12:38 not-on-body, 13:36 not-on-body, 17:24 point-at-rest",
        ),
        ("kind of joint", {"type: pin, at: O": "type: screw, at: O"}, "11:14 choice"),
        ("unknown body", {"bodies: [1, 2]}": "bodies: [1, 7]}"}, "12:38 no-such-body"),
        ("body joined to itself", {"bodies: [1, 2]}": "bodies: [1, 1]}"}, "12:38 same-body"),
        ("pin beside its body", {"at: A, bodies": "at: O, bodies"}, "12:38 not-on-body"),
        ("line without direction", {"body: 2, angle: 0 deg}": "body: 2}"}, "13:7 missing-key"),
        ("line of one point", {"angle: 0 deg}\n": "along: [A, A]}\n"}, "13:50 same-point"),
        (
            "rate of a fixed point",
            {"{type: omega, body: 1, value: 10 rad/s}": "{type: velocity, point: Z, direction: 0 deg}"},
            "15:31 no-such-point",
        ),
        ("wrong unit", {"10 rad/s}": "10 m/s}"}, "15:37 wrong-unit"),
        ("no such quantity", {"find: [v.A": "find: [w.A"}, "17:10 no-asked-quantity"),
        ("velocity of a body", {"find: [v.A": "find: [v.2"}, "17:10 no-asked-quantity"),
        ("positions of an exercise", {"parameters:\n": "positions: {count: 8}\n…"}, "2:1 unknown-key"),
        (
            "ε not given",
            {"    - {type: epsilon, body: 1, value: 0 rad/s2}\n": ""},
            "16:24 undetermined, 16:29 undetermined",
        ),
        (
            "guide missing",
            {"    - {type: slot, point: B, body: 2, angle: 0 deg}\n": ""},
            "16:15 undetermined, 16:24 undetermined, 16:29 undetermined",
            "omega.2 does not follow",
            "stays open: 2",
        ),
        (
            "two speeds",
            {"{type: epsilon": "{type: velocity, point: B, size: 1 m/s, direction: 0 deg}\n    - …"},
            "16:7 contradiction",
            "velocity B contradicts pin O, pin A, slot B, omega 1",
        ),
        ("method of no name", {"find: [v.A": "methods: [guessing]\n  …"}, "17:13 choice"),
        ("method named twice", {"find: [v.A": "methods: [projection, projection]\n  …"}, "17:25 method-repeated"),
        ("no moving frame", {"find: [v.A": "methods: [moving frame]\n  …"}, "17:13 no-moving-frame"),
        (
            "circles apart",
            {
                "from: A, distance: 1 m, angle: -45 deg": (
                    "distances: [{from: O, distance: 1 m}, {from: A, distance: 0.7 m}]"
                )
            },
            "6:20 circles-apart",
        ),
        (
            "accelerations alone contradict",
            {"{type: epsilon": "{type: acceleration, point: B, size: 1 m/s2, direction: 0 deg}\n    - …"},
            "17:7 contradiction",
            "contradicts",
            "accelerations",
            "pin O",
            "pin A",
            "slot B",
            "acceleration B",
        ),
        (
            "direction beside a guide",
            {"{type: epsilon": "{type: velocity, point: B, direction: 90 deg}\n    - …"},
            "16:7 contradiction",
            "velocity B contradicts",
        ),
        # A second guide along the first, and a rate that follows from the others, are passive.
        (
            "said twice",
            {
                "  given:\n": "    - {type: slot, point: B, body: 2, angle: 180 deg}\n…",
                "{type: epsilon": "{type: velocity, point: A, size: 2 m/s, direction: 135 deg}\n    - …",
            },
            RIGHT,
        ),
    ],
    "plane-motion-symbols": [
        ("no such symbol", {"distance: 0.2 m": "distance: 2*r + q"}, "6:28 no-such-symbol"),
        ("no formula", {"distance: 0.2 m": "distance: r l"}, "6:28 no-formula"),
        ("no call", {"distance: 0.2 m": "distance: exp(r)"}, "6:28 no-formula"),
        ("unlike terms", {"distance: 0.2 m": "distance: r + omega"}, "6:28 unlike-terms"),
        ("formula of another kind", {"value: 10 rad/s": "value: r*omega"}, "16:37 wrong-unit"),
        ("formula out of range", {"distance: 0.2 m": "distance: r - l"}, "6:28 out-of-range"),
        ("symbol without unit", {"r: 0.2 m": "r: 2"}, "3:16 missing-unit"),
        ("symbol of no length", {"r: 0.2 m": "r: -0.2 m"}, "3:16 out-of-range"),
        ("symbol of another body", {"omega: 10": "omega2: 10"}, "3:31 symbol-of-body"),
        ("symbol of no rotation", {"omega: 10 rad/s": "omega1: 10 rad/s"}, "3:31 symbol-of-body"),
        ("name of a symbol", {"{r: 0.2 m": "{r_1: 0.2 m"}, "3:13 symbol-name"),
    ],
    "plane-motion-wheels": [
        ("no component", {"find: [omega.1": "methods: [projection]\n  find: [omega.1"}, "16:13 no-projection"),
        ("disc above its line", {"[0 m, 1 m]": "[0 m, 1.1 m]"}, "11:7 no-contact", "1100 mm", "1000 mm"),
        (
            "belt about discs in each other",
            {"gears, discs: [1, 2]": "belt, crossed: true, discs: [1, 2]"},
            "13:7 belt-too-short",
        ),
        ("gears apart", {"[0 m, 3 m]": "[0 m, 4 m]"}, "13:7 no-contact-of-discs"),
        (
            "no disc",
            {"1: {points: [D], disc: {centre: C, radius: 1 m}}": "1: {points: [D, C]}"},
            "11:37 no-disc, 13:29 no-disc",
        ),
        (
            "moves at these values alone",
            {
                "parameters:\n": "parameters:\n  symbols: {r: 1 m}\n",
                "2: {disc: {centre: E, radius: 1 m}}": "2: {disc: {centre: E, radius: r}}",
            },
            "3:12 only-at-values",
        ),
        # Two wheels on the ground with a rod between their centres: a second velocity for one is too much.
        ("wheels with a rod between them", ROD, RIGHT),
        (
            "wheels of two speeds",
            ROD | {"  find": "    - {type: velocity, point: E, size: 1 m/s, direction: 0 deg}\n…"},
            "16:7 contradiction",
            "velocity E contradicts",
            "cord C E",
        ),
    ],
    "plane-motion-rods": [
        # Its rods have no two guided points.
        (
            "no instant centre",
            {"find: [v.D]": "…\n  methods: [instant centre]"},
            "29:13 no-directions",
            "whose directions of motion are known",
        ),
        (
            "no base point",
            {"find: [v.D]": "…\n  methods: [base point]"},
            "29:13 no-base-point",
            "two points that move along known lines",
        ),
        ("no equations", {"find: [v.D]": "…\n  methods: [equations]"}, "29:13 no-equations"),
    ],
    "plane-motion-lever": [
        (
            "method for a rotation",
            {"find: [v.A]": "…\n  methods: [base point]"},
            "13:13 no-plane-motion",
            "no body is in plane motion",
        )
    ],
    "plane-motion-points": [
        # Along AB, which is x, a_B − a_A = −ω² l cannot be positive.
        ("ends that slow down", {"size: 1 m/s2": "size: -3 m/s2"}, RIGHT),
        ("ends that part a little", {"size: 1 m/s2": "size: 2.001 m/s2"}, "12:7 points-part"),
        ("ends that part", {"size: 1 m/s2": "size: 3 m/s2"}, "12:7 points-part"),
    ],
    "cam": [
        ("a right cam", {}, RIGHT),
        ("phases beyond a turn", {"near: 120 deg": "near: 150 deg"}, "7:11 cam-phases"),
        ("phases short of a turn", {"near: 120 deg": "near: 100 deg"}, "7:11 cam-phases"),
        (
            "phases without room for a near dwell",
            {"far: 30 deg, return: 90 deg, near: 120 deg": "far: 30 deg, return: 250 deg"},
            "7:11 cam-phases",
        ),
        ("no stroke", {"  h: 40 mm\n": ""}, "3:1 missing-key"),
        ("a stroke of nothing", {"h: 40 mm": "h: 0 mm"}, "6:6 out-of-range"),
        ("an arm that translates", {"  h: 40 mm": "…\n  arm: 90 mm"}, "7:3 cam-idle-key"),
        ("offset beyond the base circle", {"e: 10 mm": "e: 40 mm"}, "11:6 cam-offset"),
        ("roller larger than the base circle", {"roller: 10 mm": "roller: 40 mm"}, "12:11 cam-roller"),
        (
            "a length sought without limits",
            {"r0: 40 mm": "r0: find", "  limits: {rise: 30 deg, return: 70 deg}\n": ""},
            "3:1 missing-key",
        ),
        ("an offset sought alone", {"e: 10 mm": "e: find"}, "11:6 cam-find-r0"),
        (
            "acceleration that does not end at rest",
            {"return: 3-4-5": "return: {x: [0, 0.5, 0.5, 1], a: [1, 1, -2, -2]}"},
            "8:57 cam-areas",
        ),
        (
            "acceleration that moves back first",
            {"return: 3-4-5": "return: {x: [0, 0.5, 0.5, 1], a: [-1, -1, 1, 1]}"},
            "8:57 cam-backwards",
        ),
        ("acceleration of other lengths", {"return: 3-4-5": "return: {x: [0, 1], a: [1, 0, -1]}"}, "8:47 row-length"),
        ("acceleration over too little", {"return: 3-4-5": "return: {x: [0, 0.9], a: [1, -1]}"}, "8:40 table-end"),
        (
            "acceleration that runs back",
            {"return: 3-4-5": "return: {x: [0, 0.6, 0.4, 1], a: [1, 1, -1, -1]}"},
            "8:45 not-increasing",
        ),
        ("a law nobody knows", {"rise: cosine": "rise: spline"}, "8:10 choice"),
        ("steps of no phase", {"  h: 40 mm": "…\n  positions: {up: 6}"}, "7:14 unknown-key"),
        (
            "a dwell of nothing divided",
            {"far: 30 deg, return: 90 deg": "far: 0 deg, return: 120 deg", "  h: 40 mm": "…\n  positions: {far: 2}"},
            "7:20 cam-no-phase",
        ),
        (
            "a position that is not there",
            {"report: {language: en}": "report: {language: en, worked_positions: [40]}"},
            "2:43 no-such-position",
        ),
        ("no room for a roller", {"roller: 10 mm": "roller: find\n  rho: 60 mm"}, "12:11 cam-no-roller"),
    ],
    "cam-rocker": [
        ("an arm too short for the triangle", {"r0: 80 mm": "r0: 40 mm"}, "12:7 cam-triangle"),
        (
            "an arm that swings past the cam",
            {
                "psi_max: 15 deg": "psi_max: 120 deg",
                "arm: 132 mm": "arm: 100 mm",
                "a: 180 mm": "a: 110 mm",
                "r0: 80 mm": "r0: 190 mm",
            },
            "6:12 cam-past",
        ),
        (
            "limits that no cam keeps",
            {
                "r0: 80 mm": "r0: find",
                "rise: 40 deg, return: 50 deg": "rise: 5 deg, return: 5 deg",
                "psi_max: 15 deg": "psi_max: 30 deg",
                "arm: 132 mm": "arm: 132 mm\n  lifts: with",
            },
            "12:11 cam-no-centre",
        ),
        (
            "a follower faster than the cam",
            {"psi_max: 15 deg": "psi_max: 80 deg\n  lifts: with"},
            "10:11 cam-overtakes",
        ),
        (
            "a face that reaches the pivot",
            {
                "end: roller": "end: flat",
                "  arm: 132 mm\n": "",
                "  limits: {rise: 40 deg, return: 50 deg}\n": "",
                "r0: 80 mm\n  roller: 15 mm": "r0: 190 mm",
            },
            "10:7 cam-face",
        ),
        (
            "a face that nothing makes convex",
            {
                "end: roller": "end: flat",
                "  arm: 132 mm\n": "",
                "  limits: {rise: 40 deg, return: 50 deg}\n": "",
                "r0: 80 mm\n  roller: 15 mm": "r0: find",
                "psi_max: 15 deg": "psi_max: 35 deg",
            },
            "10:7 cam-not-convex",
        ),
        (
            "a face that runs off in the return",
            {
                "end: roller": "end: flat",
                "  arm: 132 mm\n": "",
                "  limits: {rise: 40 deg, return: 50 deg}\n": "",
                "psi_max: 15 deg": "psi_max: 45 deg",
                "  roller: 15 mm\n": "",
            },
            "8:11 cam-overtakes",
        ),
        (
            "a face that nothing places",
            {
                "end: roller": "end: flat",
                "  arm: 132 mm\n": "",
                "  limits: {rise: 40 deg, return: 50 deg}\n": "",
                "a: 180 mm": "a: find",
                "r0: 80 mm\n  roller: 15 mm": "r0: find",
            },
            "7:6 cam-free",
        ),
    ],
}
"""By file: (name, {what is replaced: by what}, faults, words that the English messages hold, …)."""

WHOLE: list[tuple[str, bytes, str]] = [
    ("empty", b"", "1:1 empty"),
    ("comments only", b"# nothing\n\n", "1:1 empty"),
    ("an empty document", b"---\n", "1:1 empty"),
    ("a list", b"- kind: engine-twin\n", "1:1 wrong-type"),
    ("a word", b"engine\n", "1:1 wrong-type"),
    ("NUL", b"kind: a\nvariant: \0\n", "2:10 binary"),
    ("a picture", b"\x89PNG\r\n\x1a\n\xff\xfe\xfd", "1:1 encoding"),
    ("UTF-16 that breaks off", "kind: a\nvariant: phương".encode("utf-16") + b"x", "2:16 encoding"),
    ("another encoding", "kind: a\nvariant: phương".encode("utf-16-le"), "1:2 binary"),
    ("broken UTF-8", "variant: ph\xe9".encode("latin-1"), "1:12 encoding"),
    ("control character", b"kind: a\nvariant: \x07\n", "2:10 control-character"),
    ("absurd size", b"# " + b"x" * 1_000_000, "1:1 too-large"),
    ("endless keys", b"".join(b"k%d: 1\n" % n for n in range(40_000)), "201:1 too-many"),
    ("endless nesting", b"a: " + b"[" * 5000, "1:15 too-deep"),
    ("endless mappings", b"{a: " * 5000, "1:46 too-deep"),
    (
        "alias bomb",
        b"a: &a [x, x]\nb: &b [*a, *a]\nc: [*b, *b]\n",
        "1:4 alias, 2:4 alias, 2:8 alias, 2:12 alias, 3:5 alias, 3:9 alias",
    ),
]
"""Files that no change of a right one makes: (name, bytes, faults)."""
