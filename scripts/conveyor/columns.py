"""The results of many runs: one array for each quantity, by its name."""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

UNITS = {
    **{"mean_velocity": "m/s", "z_end": "m", "vz_end": "m/s", "x_end": "m", "vx_end": "m/s", "max_gap": "m"},
    **{"impacts": "1", "contact_fraction": "1", "impact_speed": "m/s", "peak_force": "N"},
    **{"x": "m", "vx": "m/s", "z": "m", "vz": "m/s", "contact_force": "N", "friction_force": "N"},
    **{"arrival": "s", "velocity": "m/s", "acceleration": "m/s²", "displacement": "m"},
    **{"period": "1", "longest_flight": "1", "cycles": "1", "delta": "m", "v": "m/s"},
    **{"lambda_1": "1/s", "lambda_2": "1/s", "stderr": "1/s"},
    **{"airtime": "1", "largest_tilt": "rad"},
    **{"state": "", "status": ""},
}


class Columns(Mapping[str, np.ndarray]):
    """Arrays of one shape, or of shapes that begin alike, as items or attributes: columns["z_end"] or columns.z_end.

    Names, units and words are those of the tables that the pipeline writes.

    Examples
    --------
    >>> runs = sweep(parameter_table(Conveyor(), z0=[0.0, 3e-4]), duration=0.1)
    >>> runs.impacts.tolist(), runs.units["z_end"]
    ([4, 5], 'm')
    """

    def __init__(self, arrays: Mapping[str, np.ndarray]):
        self._arrays = dict(arrays)

    def __getitem__(self, name: str) -> np.ndarray:
        return self._arrays[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._arrays)

    def __len__(self) -> int:
        return len(self._arrays)

    def __getattr__(self, name: str) -> np.ndarray:
        if name.startswith("_") or name not in self._arrays:
            raise AttributeError(f"there is no column {name!r}")
        return self._arrays[name]

    def __repr__(self) -> str:
        return f"Columns({', '.join(f'{name} {array.shape}' for name, array in self.items())})"

    def select(self, rows: np.ndarray | slice) -> "Columns":
        """Some of the rows."""
        return Columns({name: array[rows] for name, array in self.items()})

    @staticmethod
    def concatenate(parts: Sequence["Columns"]) -> "Columns":
        """The rows of several results with equal columns, below each other."""
        return Columns({name: np.concatenate([part[name] for part in parts]) for name in parts[0]})

    @property
    def units(self) -> dict[str, str]:
        """The unit of each column; "1" for numbers without dimension, "" for words."""
        return {name: UNITS[name] for name in self}

    def as_dict(self) -> dict[str, np.ndarray]:
        """One-dimensional arrays that share the memory of the columns.

        pandas.DataFrame(columns.as_dict(), copy=False) copies nothing.

        ValueError if the columns have several shapes.
        """
        if len({array.shape for array in self.values()}) > 1:
            raise ValueError(f"{self!r} have no common shape")
        return {name: array.reshape(-1) for name, array in self.items()}
