"""Asking: the session, which alone changes the document, and what works behind it."""
