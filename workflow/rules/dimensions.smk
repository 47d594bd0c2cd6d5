# Fractal dimensions of phase portraits.
entry_rule("dimensions", "dimensions.portraits", "Fractal dimensions", threads=THREADS, mem_mb=2000)
