"""A class at once: roster and spec in, one assignment file a student out."""
