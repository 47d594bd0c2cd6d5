# The floor paper: the figures of the paper and about it, and its claims.

# Of the target `paper`.
PAPER_FIGURES = [figure for figure in config["figures"] if re.fullmatch(r"fig\d+", figure)]
if config["model"].get("harmonics"):
    NO_FIGURES["sensitivity"] = (
        "its bifurcations are solved in dimensionless groups, which a plate with harmonics has not"
    )


include: "common.smk"
include: "sweeps.smk"
include: "motion.smk"
include: "orbits.smk"
include: "dimensions.smk"
include: "fit.smk"
include: "sensitivity.smk"
include: "claims.smk"


FLOOR_FILES += CLAIM_FILES
BUILT += [table("results/claims"), result("claims.md")]
TESTED += ["orbits/", "lyapunov/", "results/"]
TIMED += ["certificate_times"]


rule paper:
    """The figures of the paper and its claims."""
    input:
        figure_files(PAPER_FIGURES),
        caption_files(PAPER_FIGURES),
        CLAIM_FILES,
    localrule: True
