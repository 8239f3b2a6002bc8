"""The regulated cycle, for topics that calculate with the flywheel."""

from __future__ import annotations

from reportgen.flywheel.regulation import regulated_cycle
from reportgen.machine.shared_results import REGULATED_CYCLE, PhysicsHooks, Provision

HOOKS = PhysicsHooks(provides=(Provision(REGULATED_CYCLE, regulated_cycle),))
