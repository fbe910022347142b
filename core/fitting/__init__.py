"""How the template is laid on a body, and how well it lies."""
