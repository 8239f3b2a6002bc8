"""Topic: the true motion of a machine under a drive, its start and stop, the choice of a motor."""
