"""Balancing: rotors by correction masses in one plane or two, engines by orders and stars of cranks."""
