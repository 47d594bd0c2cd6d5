# Eq. 13 fitted to critical initial heights.
entry_rule(
    "regressions",
    "fit.regressions",
    "Fit of Eq. 13",
    input={"critical": lambda wildcards: table("critical", config["regressions"][wildcards.name]["critical"])},
    runtime=10,
    params={"settings": lambda wildcards: config["regressions"][wildcards.name]},
)
