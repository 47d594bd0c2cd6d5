"""Numbers of the caption of the figure fig12."""

import pandas as pd


def name_state(state: str) -> str:
    """A state of motion in a sentence: "the first state", "chaos"."""
    return f"the {state} state" if state in ("first", "second") else state


def numbers(*, map: pd.DataFrame) -> dict:
    """The only state of a map, None if there are several, and the share of undecided initial conditions."""
    states = map.state.unique()
    is_one = len(states) == 1 and states[0] != "undecided"
    return {"only": name_state(states[0]) if is_one else None, "undecided": (map.state == "undecided").mean()}
