"""Numbers of the caption of the figure fig09."""

import pandas as pd


def numbers(*, converged: pd.DataFrame) -> dict:
    decided = converged[converged.state != "undecided"]
    changes = decided.groupby("acceleration").state.agg(lambda state: state.nunique() > 1 and "first" in set(state))
    return {"changes": bool(changes.any()), "undecided": 1.0 - len(decided) / len(converged)}
