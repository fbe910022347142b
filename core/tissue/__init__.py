"""Soft tissue as a solid between skin and chest wall."""
