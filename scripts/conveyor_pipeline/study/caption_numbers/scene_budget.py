"""Numbers of the caption of the figure scene_budget."""

import pandas as pd

VARIANTS = {"rigid": "rigid part", "half": "half the time"}  # of the scene budget


def numbers(*, budget: pd.DataFrame) -> dict[str, pd.Series]:
    """Whether a variant differs visibly from the full model, for each table."""
    rows = budget.drop_duplicates(["table", "variant", "tolerance"])
    return {name: rows[rows.variant == variant].visible for name, variant in VARIANTS.items()}
