# Fractal dimensions of phase portraits.
entry_rule("dimensions", "dimensions.portraits", "Fractal dimensions", threads=2, mem_mb=2000)
