"""An independent finite-element model of soft tissue, against which the product's tissue is compared."""
