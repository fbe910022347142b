"""Reading and writing files: regular files only, whole or not at all."""
