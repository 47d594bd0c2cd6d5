"""The contact force F_c = k_c δ^p + d_c δ̇ itself, in plain Python, for compiled code and for `impact`."""


def spring_and_damper(elastic, damping, speed):
    """F_c of a closed contact from k_c δ^p, d_c and δ̇ (Eq. 7), or F_c/m from these values per mass."""
    return elastic + damping * speed
