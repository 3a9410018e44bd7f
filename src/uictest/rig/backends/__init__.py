"""How the model is run: plain Python, machine code, SIMD lanes."""
