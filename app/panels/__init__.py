"""The parts of the window; they take plain values, emit signals and do not know each other."""
