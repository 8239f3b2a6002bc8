"""The torque that friction takes from the driver, for topics that calculate with it."""

from __future__ import annotations

from reportgen.friction.friction_torque import friction_loss
from reportgen.machine.shared_results import LOST_TORQUE, PhysicsHooks, Provision

HOOKS = PhysicsHooks(provides=(Provision(LOST_TORQUE, friction_loss),))
