"""Plain values and texts for window, command line and report, one module a feature. Without Qt."""
