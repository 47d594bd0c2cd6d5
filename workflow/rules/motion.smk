# The motion of single parts: over time, as spectra, at their first impacts; heights at which their state changes.
entry_rule("signals", "motion.signals", "Signals over time", runtime=10)
entry_rule("spectra", "motion.spectra", "Spectra of the velocities", runtime=10)
entry_rule("impacts", "motion.impacts", "First impacts", threads=THREADS, runtime=10)
entry_rule("critical", "motion.critical_heights", "Critical initial heights", threads=THREADS)
