"""Topic: sliders with a face of finite width, which may tilt in their guides."""
