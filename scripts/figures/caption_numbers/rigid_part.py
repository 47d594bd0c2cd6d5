"""Numbers of the caption of the figure rigid_part."""

import pandas as pd

from accuracy.rigid_part import CONTACT, RIGID
from claims.finding import onset


def numbers(*, rigid: pd.DataFrame) -> dict[str, float]:
    from_rest = rigid[(rigid.kind == "velocity") & (rigid.z0 == 0.0)].sort_values("acceleration", kind="stable")
    leaves = {model: onset(rows.acceleration, rows.state != "first") for model, rows in from_rest.groupby("model")}
    first = rigid[rigid.kind.isin(("fold", "period doubling")) & (rigid.number == 1)]
    places = first.pivot_table(index="model", columns="kind", values="acceleration")
    later = 100.0 * (places.loc[RIGID] / places.loc[CONTACT] - 1.0)
    return {
        "leaves": leaves[CONTACT],
        "rigid_leaves": leaves[RIGID],
        "fold_later": later["fold"],
        "doubling_later": later["period doubling"],
    }
