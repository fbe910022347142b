"""What makes a raw scan one clean skin: before the unit is known, after it, and noise taken out."""
