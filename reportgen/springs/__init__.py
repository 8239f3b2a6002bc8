"""Topic: springs that act on the links of a machine."""
