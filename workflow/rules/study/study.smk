# The floor study: what methods cost, and where they fail.

STUDY_FIGURES = listed_figures("work_precision", "stability", "scene_budget", "settling")


include: "accuracy.smk"


BUILT += [result("benchmark.md")] if RESULT_TESTS else []
TESTED += ["precision/"]
TIMED += ["precision_times", "budget_times"]
TIMED_PAGES += [result("benchmark.md")]


rule study:
    """The figures about methods."""
    input:
        figure_files(STUDY_FIGURES),
        caption_files(STUDY_FIGURES),
    localrule: True
