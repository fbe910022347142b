"""What is measured on a body, and how: girths, cups, ways over the skin, volumes of breasts."""
