# How bifurcations and critical heights move with each parameter, and where folds and doublings go in two of them.
SENSITIVITY = {**config["sensitivity"], "model": of_sections("orbits")["model"]}

RULES["sensitivity"] = {
    "stage": "sensitivity.derivatives",
    "message": "Derivatives of bifurcations and critical heights by each parameter",
    "input": {
        **tables_of("orbits", "folds_and_doublings", "cascade"),
        "critical": table("critical", config["sensitivity"]["critical"]),
    },
    "output": tables_of("sensitivity", "derivatives", "groups"),
    "place": "sensitivity/derivatives",
    "params": {"settings": {name: value for name, value in SENSITIVITY.items() if name != "curves"}},
}

RULES["curves"] = {
    "stage": "sensitivity.curves",
    "message": "Folds and period doublings in two parameters",
    "input": tables_of("orbits", "folds_and_doublings", "cascade"),
    "output": tables_of("sensitivity", "continued", "meetings"),
    "place": "sensitivity/curves",
    "threads": THREADS,
    "params": {"settings": {name: SENSITIVITY[name] for name in ("longest_period", "curves", "model")}},
}
