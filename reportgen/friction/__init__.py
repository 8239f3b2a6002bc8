"""Topic: friction in the joints of a machine, and the exercises on friction."""
