"""An exercise of plane motion worked out as at the board: from body to body, each step with its definition."""
