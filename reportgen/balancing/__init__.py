"""Topic: balancing of machines by counterweights; also the kinds of rotors (correction masses) and engines by
orders.
"""
