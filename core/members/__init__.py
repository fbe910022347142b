"""What pulls inside the control mesh, and its stiffness in band storage."""
