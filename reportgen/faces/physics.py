"""The faces of sliders, for topics that apply forces at their ends."""

from __future__ import annotations

from reportgen.faces.ends import faces_of
from reportgen.machine.shared_results import FACES, PhysicsHooks, Provision

HOOKS = PhysicsHooks(provides=(Provision(FACES, faces_of),))
