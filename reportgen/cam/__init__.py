"""Cams: from the law of motion to the profile, as a kind of work that follows the case protocol."""
