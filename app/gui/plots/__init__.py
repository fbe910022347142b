"""Live plots of convergence and sections."""
