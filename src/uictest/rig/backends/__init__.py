"""How machine code runs the model: to standstill, stepped, in lanes, beside a recording; what it is given."""
