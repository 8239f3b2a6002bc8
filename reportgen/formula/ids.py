"""The ids of all quantities, by families: `ids.velocity("B")` is v.B, `ids.reaction("12", "t")` is R.12.t.

A quantity that is the only one of its family has its id as text (`mu.l`, `omega.1`, `M.eq`). No two families match
the same id, with two exceptions: the distance of a centre of percussion is also a length, and families that put a
word before any other id match more. If two families match, the first one applies. One template has two names where
machines differ: s.3 is the displacement of a slider, or the place of the mass centre on a rod.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from functools import cached_property

from reportgen.base.records import Record

# --- one template makes the ids of a family and reads them ----------------------------------------
# velocity = Name("v.{point}")
# velocity("B") == "v.B"
# velocity.read("v.B") == {"point": "B"}
# "v.B" in velocity
# A template is a text with places in braces; `PLACES` gives the words allowed in them. Text in brackets is optional.

PLACES: Mapping[str, str] = {
    # links and the forces between them
    "link": r"\d+",
    "wheel": r"\d+′?|H",
    "number": r"\d+",
    "slider": r"\d|[A-Z][^.]*",
    "group": r"\d[\d,]*",
    "joint": r"\d[\d,]+|cb",
    "force": r"[A-Z][^.]*(?:\.[ntkrs])?",
    # points and what lies between them
    "point": r"[A-Z][^.]*",
    "about": r"[A-Z][^.]*",
    "line": r"[A-Z][^.]*",
    "to": r"[A-Z][^.]*",
    "relative": r"[A-Z][^.]*",
    "pair": r"[A-Z][^.]*[A-Z][^.]*",
    "start": r"[a-z]\d*",
    "end": r"[a-z]\d*",
    # the meaning of a quantity's variant
    "what": "[va]",
    "plan": "[lva]",
    "rate": "omega|eps",
    "axis": "[xy]",
    "part": "[ntkrs]",
    "slide": "[kr]",
    "letter": "[a-z]",
    "bound": "max|min",
    "stroke": "work|back",
    "method": "eq|vw",
    "figure": r"r|c|given|mean|mean\.positions|least|greatest|energy|difference|share",
    "matrix": "d?[AB]",
    # any rest of an id
    "corner": ".+",
    "edge": ".+",
    "id": ".+",
}
"""Regular expressions of the words allowed in a place; any other place takes one word without dots."""

_PLACE = re.compile(r"\{(\w+)\}")
_MAY_BE_MISSING = re.compile(r"\[(.*?)\]")
_POINT = re.compile(r"[A-Z]\d*")


class Name(Record, dict=True):
    """A family of ids, as a template: `R.{joint}[.{part}]` is R.12 as well as R.12.t."""

    text: str

    def __call__(self, *of: object) -> str:
        """Return the id with these words in its places; raise `KeyError` if they are too many or too few."""
        return self._forms[len(of)] % of

    def read(self, id: str) -> dict[str, str] | None:
        """Return the words in the places of an id, "" for a missing one; None for an id of another family."""
        # Most families begin with other letters, so that their patterns need not be compiled.
        if not id.startswith(self._beginning):
            return None
        matched = self._pattern.fullmatch(id)
        return None if matched is None else {name: text or "" for name, text in matched.groupdict().items()}

    def __contains__(self, id: str) -> bool:
        return id.startswith(self._beginning) and self._pattern.fullmatch(id) is not None

    def may_begin(self, word: str) -> bool:
        """Return False if no id of the family begins with a word, which ends before a dot or with the id."""
        return word.startswith(self._beginning) or self._beginning.startswith(word)

    def only(self, **words: str) -> Name:
        """Return the narrower family that has these words in these places."""
        return Name(_PLACE.sub(lambda place: words.get(place[1], place[0]), self.text))

    def of(self, words: Mapping[str, str]) -> str:
        """Return the id with these words in its places, as `read` gives them; an empty word leaves its place out."""
        return self(*(words[place] for place in _PLACE.findall(self.text) if words[place]))

    @cached_property
    def _forms(self) -> Mapping[int, str]:
        """Templates for the words, by their number: with and without the part in brackets."""
        texts = _MAY_BE_MISSING.sub("", self.text), _MAY_BE_MISSING.sub(r"\1", self.text)
        return {len(_PLACE.findall(text)): _PLACE.sub("%s", text) for text in texts}

    @cached_property
    def _beginning(self) -> str:
        """Common beginning of all ids of the family."""
        return re.split(r"[{\[]", self.text, maxsplit=1)[0]

    @cached_property
    def _pattern(self) -> re.Pattern[str]:
        def plain(text: str) -> str:
            return re.escape(text).replace(r"\[", "(?:").replace(r"\]", ")?")

        between, *places = _PLACE.split(self.text)
        parts = [plain(between)]
        for place, after in zip(places[::2], places[1::2], strict=True):
            parts += [f"(?P<{place}>{PLACES.get(place, '[^.]+')})", plain(after)]
        return re.compile("".join(parts))


# --- the families --------------------------------------------------------------------------------
# --- geometry: true lengths, lengths on the drawing, places and directions

percussion = Name("l.{point}K{link}")  # to the centre of percussion
length = Name("l.{line}[{to}]")  # AB in one word or in two
drawn = Name("drawn.{line}[{to}]")
laid_line = Name("laid.{line}[{to}]")
scale = Name("mu.{plan}")
place = Name("p.{point}")
coordinate = Name("{point}.{axis}")
mass_centre = Name("s.{link}")  # place of the mass centre as a share of a rod's length
along_link = Name("{point}.along")
across_link = Name("{point}.across")
frame_coordinate = Name("frame.{axis}.{point}")
point_turn = Name("turn.{point}")  # turn from the rod to the arm of a point of its link
rod = Name("rod.{link}")
link_axis = Name("axis.{link}")
slot = Name("slot.{link}")
slot_on_link = Name("slot.{link}.local")
guide = Name("guide.{link}")
guide_on_link = Name("guide.{link}.local")
guide_place = Name("guide.{link}.at")
guide_place_on_link = Name("guide.{link}.at.local")
plate_trial = Name("near.{link}.{of}")  # pose of a ternary link near which it is drawn
similar = Name("similar.{point}")  # its image by the similarity theorem
angle = Name("phi.{of}")
inclination = Name("beta.{link}")
slope = Name("eta.{point}")
inner_angle = Name("alpha.{number}")
outer_angle = Name("psi.{number}")

# --- masses

weight = Name("G{link}")
mass = Name("m.{link}")
inertia = Name("J.{link}")
reduced_inertia = Name("J.r.{link}")

# --- rotation of links

angular_velocity = Name("omega.{link}")
angular_acceleration = Name("eps.{link}")
signed = Name("turn.{rate}.{link}")  # anticlockwise positive
bound_of_speed = Name("omega.{bound}")
tangent = Name("psi.{bound}")  # to the energy–mass diagram
LINK_RATE: Mapping[str, Name] = {"omega": angular_velocity, "eps": angular_acceleration}

# --- plans of velocities and accelerations

velocity = Name("v.{point}")
acceleration = Name("a.{point}[.{part}]")
POLE = "p"
"""The pole of both plans, the image of all fixed points."""
POINT_RATE: Mapping[str, Name] = {"v": velocity, "a": acceleration}
stroke_velocity = Name("v.{stroke}")
segment = Name("seg.{what}.{start}{end}")
relative_segment = Name("seg.a.{part}.{relative}")
laid = Name("laid.{what}.{edge}")
plan_point = Name("plan.{what}.{corner}")
direction = Name("dir.{what}.{point}")

# --- exercises of plane motion

velocity_component = Name("v.{point}.{axis}")
acceleration_component = Name("a.{point}.{axis}")
COMPONENT: Mapping[str, Name] = {"v": velocity_component, "a": acceleration_component}
velocity_projection = Name("v.{point}.along.{line}")
sliding_velocity = Name("v.{point}.r")
centre_coordinate = Name("centre.{link}.{axis}")
velocity_factor = Name("k.{point}")
share = Name("share.{rate}.{link}.{id}")  # of another quantity in a rotation
heading = Name("way.{what}.{point}")  # angle that defines the direction

# --- instant centres

centre = Name("ic.{link}")
centre_reach = Name("ic.reach.{link}")
centre_distance = Name("ic.seg.{link}.{point}")
centre_omega = Name("ic.omega.{link}")
centre_velocity = Name("ic.v.{link}")
rod_angle = Name("ic.angle.{link}.{point}")
projection = Name("ic.along.{link}.{point}")
CENTRES = (centre, centre_reach, centre_distance, centre_omega, centre_velocity, rod_angle, projection)

# --- closed formulas

formula_angle = Name("f.phi.{link}")
formula_coordinate = Name("f.{axis}.{line}")
formula_component = Name("f.{axis}.{point}.{what}")
formula_velocity = Name("f.v.{point}")
formula_acceleration = Name("f.a.{point}[.{part}]")
formula_sliding = Name("f.{what}.{slide}")
formula_angular_velocity = Name("f.omega.{link}")
formula_angular_acceleration = Name("f.eps.{link}")
slider_way = Name("x.{slider}")
loop_distance = Name("f.d.{group}")  # distance between the outer joints of a group, or of one from its guide
slide_way = Name("f.s.{joint}")  # travel of the second link on the first
slide_velocity = Name("f.v.{joint}")
slide_acceleration = Name("f.a.{joint}")
matrix_entry = Name("{matrix}.{number}")
right_side = Name("f.b.{what}.{line}")  # right-hand side of the equations of a loop
numerator = Name("q.{link}")

# --- loads

displacement = Name("s.{link}")
displacement_on_paper = Name("way.{link}")
stroke = Name("H.{link}")
node = Name("node.{of}.{link}")  # node of an indicator diagram, next to a position
load_node = Name("node.{of}.{force}")  # node of the table of a load
pressure = Name("p.{link}")
applied_force = Name("P{link}[{letter}]")  # a letter where a link has several
applied_torque = Name("M{link}[{letter}]")
given_force = Name("P[{point}].given")
spring_rate = Name("spring.c.{number}")
spring_free = Name("spring.free.{number}")  # its length, or its angle, when slack
spring_length = Name("spring.l.{number}")
spring_on_paper = Name("spring.drawn.{number}")
spring_turn = Name("spring.turn.{number}")  # turn of a torsion spring from slack
spring_anchor = Name("spring.at.{number}")  # the end on the frame
inertia_force = Name("Pqt{link}")
inertia_couple = Name("M.Pqt{link}")
inertia_offset = Name("e.Pqt{link}")
force_vector = Name("F.{force}")
couple = Name("couple.{force}")
lone_couple = Name("lone.{force}")  # couple where the force is zero
beside = Name("beside.{force}")  # from the mass centre to where an inertia force acts
sense = Name("sense.{force}")
assumed = Name("assumed.{force}")  # the sense that its formula assumes
down = Name("down.{link}")  # the direction of its weight

# --- reactions

reaction = Name("R.{joint}[.{part}]")
reaction_couple = Name("M.{joint}")
application = Name("x.{joint}")
face_from, face_to, face_below = Name("face.from.{link}"), Name("face.to.{link}"), Name("face.below.{link}")
normal_reaction = Name("N.{joint}")  # across a guide, with its sign
normal_place = Name("along.{joint}")  # where it acts, from the pin along the guide
face_reaction = Name("face.{joint}.{number}")  # reaction at an end of a slider that tilts
arm = Name("h.{force}.{about}")
force_scale = Name("mu.R{group}")
force_segment = Name("seg.{group}.{force}")
laid_force = Name("laid.{group}.{force}")
force_corner = Name("plan.R{group}.{corner}")
force_direction = Name("dir.{force}")

# --- the balance of the driver and the cycle

lever_arm = Name("h.{force}.p")
lever_moment = Name("M.{force}.p")
lone_moment = Name("M.{force}.lone.p")
balance = Name("M.{method}")
figure_of_balance = Name("M.{figure}")  # figure over the cycle, or of the reduced torque

# --- a word before the id of another quantity

formula = Name("f.{id}")  # the same quantity by a closed formula
far = Name("far.{id}")  # distance of a fixed place from the origin
unit = Name("unit.{id}")  # its direction
rule = Name("rule.{id}")  # value of an integral by a rule for the positions
reading = Name("read.{id}")  # value read off a curve
rest = Name("rest.{id}")  # remainder of that integral
of_part = Name("part.{id}")  # the same length in the part of a coursework that gives it

# --- names other than ids: of the forces of a plan and of the corners of a plan of accelerations

reaction_force = Name("R{joint}[.{part}]")
relative_corner = Name("{part}.{pair}")


def joint(acting: int, acted_on: int) -> str:
    """Return the digits of the force of one link on another: 12, or 1,12 with long numbers."""
    return f"{acting}{acted_on}" if max(acting, acted_on) < 10 else f"{acting},{acted_on}"


def members(links: Sequence[int]) -> str:
    """Return the digits of a group by its links: 23, 2345, or 8,9,10,11 with long numbers."""
    return ("" if max(links) < 10 else ",").join(map(str, links))


def linked(joint: str) -> tuple[str, str]:
    """Return the two links of a joint's digits, the acting one first: 12 gives "1" and "2", 1,12 gives "1" and "12"."""
    acting, acted_on = joint.split(",") if "," in joint else tuple(joint)
    return acting, acted_on


def links_of(reaction: str) -> tuple[int, int]:
    """Return the two links of a reaction by its name, the acting one first: R12.t is the force of 1 on 2."""
    names = reaction_force.read(reaction)
    assert names is not None, f"{reaction} is no reaction"
    acting, on = linked(names["joint"])
    return int(acting), int(on)


def points(named: str) -> list[str]:
    """Return the points that a place of an id names: O1A is O1 and A."""
    return _POINT.findall(named)


def of_force(name: str) -> str:
    """Return the id of a force's size by the force's name: R.12.t for R12.t; a load's size has the load's name."""
    names = reaction_force.read(name)
    return name if names is None else reaction.of(names)
