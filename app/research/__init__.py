"""Figures and claims of the paper, studies, accuracy on known bodies. Nothing imports this package."""
