"""Plane motion of rigid bodies at one instant: what joins them, and the velocities and accelerations that follow."""
