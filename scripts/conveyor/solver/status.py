"""How a run ended, whatever its method: a code in compiled functions, its name in results."""

STATUS = (
    "ok",
    "too many events",
    "contact too stiff",
    "impact not found",
    "not finite",
)
OK, TOO_MANY_EVENTS, TOO_STIFF, IMPACT_LOST, NOT_FINITE = range(5)
