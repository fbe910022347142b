"""The tensegric model: lines, volume, iteration, exact solution, sensitivities, convergence."""
