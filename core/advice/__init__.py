"""Advice: how far lines can go, what ends a fight, how sure a figure is, how even a body can be."""
