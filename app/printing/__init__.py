"""Printing: the figures of the paper and their page, without Qt."""
