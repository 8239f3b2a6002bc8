"""Topic: sliders with a face of some width, which may tilt in their guides."""
