"""Style sheet, icons and shadows."""
