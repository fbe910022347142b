"""The paper's figures and claims, studies, accuracy on known bodies."""
