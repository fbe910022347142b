"""The window's features, each with its controller and widgets."""
