"""How a scan stands: its unit, its up and its front, from the shape or as told; and what is no upper body."""
