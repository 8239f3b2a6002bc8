"""Cams: from the law of motion to the profile, as a case."""
