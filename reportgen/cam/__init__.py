"""Cams: from the law of motion to the profile, as one more kind of work that joins by the case protocol."""
