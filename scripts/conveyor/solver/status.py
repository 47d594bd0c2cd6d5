"""How a run ended, whatever its method: a code in compiled functions, its name in results."""

STATUS = (
    "ok",
    "too many events",
    "contact too stiff",
    "impact not found",
    "not finite",
    "gave up",
    "stuck at an event",
    "step too small",
    "event lost",
)
OK, TOO_MANY_EVENTS, TOO_STIFF, IMPACT_LOST, NOT_FINITE = range(5)
# Of SciPy's integrators only.
GAVE_UP, STUCK, STEP_TOO_SMALL, EVENT_LOST = range(5, 9)
