// Nothing: metal_stdlib has all that is needed.
