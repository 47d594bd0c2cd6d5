# Where to run a conveyor: the motions in which the starts of a box end, and what follows for who runs it.
# The box says how a part starts, the section at which amplitudes.
RULES["operating"] = {
    "stage": "operating.shares",
    "message": "Shares of the starts that end in each motion",
    "output": tables_of("operating", "shares"),
    "place": "operating/shares",
    "threads": THREADS,
    "params": {
        "settings": {
            **config["operating"],
            "settling": config["solver"]["settling"],
            "model": {
                name: value for name, value in MODEL_OF_ANY_AMPLITUDE.items() if name not in ("psi0", "z0", "vz0")
            },
        }
    },
}

RULES["regimes"] = {
    "stage": "operating.regimes",
    "message": "Where one velocity is certain, where several exist, where chaos",
    "input": tables_of("operating", "shares"),
    "output": tables_of("operating", "regimes"),
    "place": "operating/regimes",
}

RULES["operating_chart"] = {
    "stage": "operating.chart",
    "message": "The operating chart in words",
    "input": {"template": "workflow/templates/operating_chart.md", **tables_of("operating", "shares", "regimes")},
    "output": {"chart": result("operating/chart.md")},
    "place": "operating/chart",
}
