"""Reporting: the sheet on paper, painted in millimetres for screen, PDF and print alike."""
