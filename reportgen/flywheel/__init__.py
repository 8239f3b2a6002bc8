"""Topic: the flywheel that keeps the speed of a machine within bounds."""
