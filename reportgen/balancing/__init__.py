"""Topic: balancing of machines by counterweights, of rotors by correction masses, of engines by orders and stars
of cranks.
"""
