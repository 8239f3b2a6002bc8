"""Balancing of rotors: correction masses in one plane or two, by plans true to scale and by components."""
