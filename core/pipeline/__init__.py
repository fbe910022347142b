"""From scan and design to results: a staged build with reuse, the live solver, frames."""
