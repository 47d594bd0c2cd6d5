# Periodic orbits, attractors over the amplitude, their exponents, whether they are chaotic, and what is proved of them.


def of_sections(*sections):
    """A param: these sections of the config with the model and the tolerance, overrides included, later ones first.

    All of them name their amplitudes themselves.
    """
    merged = {"tolerance": config["solver"]["tolerance"]}
    if "attractors" in sections:
        merged["settling"] = config["solver"]["settling"]
    for section in sections:
        merged.update(config[section])
    return {**merged, "model": {**MODEL_OF_ANY_AMPLITUDE, **merged.get("model", {})}}


entry_rule("estimates", "orbits.estimates", "Lyapunov exponents by finite differences", threads=THREADS, mem_mb=2000)

RULES["orbits"] = {
    "stage": "orbits.branches",
    "message": "Periodic orbits",
    "output": tables_of("orbits", "branches", "folds_and_doublings", "cascade"),
    "place": "orbits/orbits",
    "params": {"settings": of_sections("orbits")},
}

# Times differ from run to run and have a table of their own; the others have equal bytes every time.
RULES["certificates"] = {
    "stage": "orbits.certified",
    "message": "Orbits, bifurcations and chaos, proved",
    "input": tables_of("orbits", "branches", "folds_and_doublings", "cascade"),
    "output": tables_of("orbits", "certificates", "certified_bifurcations", "certified_chaos", "certificate_times"),
    "timed": ("certificate_times",),
    "place": "orbits/certificates",
    "threads": THREADS,
    "mem_mb": 1500,
    "runtime": 60,
    "params": {"settings": {**config["certificates"], "model": of_sections("orbits")["model"]}},
}

RULES["attractors"] = {
    "stage": "orbits.strobes",
    "message": "Attractors over the amplitude",
    "output": tables_of("attractors", "strobes"),
    "place": "attractors/strobes",
    "threads": THREADS,
    "params": {"settings": of_sections("attractors")},
}

RULES["lyapunov"] = {
    "stage": "orbits.exponents",
    "message": "Lyapunov exponents over the amplitude",
    "input": tables_of("attractors", "strobes"),
    "output": tables_of("lyapunov", "spectrum"),
    "place": "lyapunov/spectrum",
    "threads": THREADS,
    "params": {"settings": of_sections("attractors", "lyapunov")},
}

RULES["witnesses"] = {
    "stage": "orbits.witnesses",
    "message": "Chaotic or not, by three witnesses",
    "input": tables_of("attractors", "strobes") | tables_of("lyapunov", "spectrum"),
    "output": tables_of("lyapunov", "witnesses"),
    "place": "lyapunov/witnesses",
    "threads": THREADS,
    "params": {"settings": of_sections("attractors", "witnesses")},
}
