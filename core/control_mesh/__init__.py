"""The control mesh: the template, its fit to a body, and paths of lines on it."""
