"""The results of many runs: one array for each quantity, by its name."""

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from . import parameters

if TYPE_CHECKING:
    import pandas

# The numbers of a harmonic in a table of parameters, see solver.plate.
WAVES = ("order", "along_cosine", "along_sine", "normal_cosine", "normal_sine")
UNITS = parameters.UNITS | {
    **{"mean_velocity": "m/s", "z_end": "m", "vz_end": "m/s", "x_end": "m", "vx_end": "m/s", "max_gap": "m"},
    **{"impacts": "1", "contact_fraction": "1", "impact_speed": "m/s", "peak_force": "N"},
    **{"x": "m", "vx": "m/s", "z": "m", "vz": "m/s", "contact_force": "N", "friction_force": "N"},
    **{"arrival": "s", "velocity": "m/s", "acceleration": "m/s²", "displacement": "m"},
    **{"period": "1", "longest_flight": "1", "cycles": "1", "delta": "m", "v": "m/s"},
    **{"lambda_1": "1/s", "lambda_2": "1/s", "stderr": "1/s"},
    **{"airtime": "1", "largest_tilt": "rad"},
    **{"attractor": "1", "share": "1", "multiplier": "1", "normal_form": "1", "strobe": "1"},
    **dict.fromkeys(("state", "status", "kind", "confirmed", "stable"), ""),
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
        # A copy is asked for names such as __setstate__ before it has columns to list.
        if name.startswith("_"):
            raise AttributeError(f"there is no column {name!r}")
        if name not in self._arrays:
            raise AttributeError(f"there is no column {name!r}; there are {', '.join(self)}")
        return self._arrays[name]

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self]

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

    def to_frame(self, parameters: np.ndarray | None = None) -> "pandas.DataFrame":
        """A data frame with one row for each point, which can be written to a Parquet file.

        parameters : the table that the columns belong to; its columns come first, and those of the result replace them.
            Harmonics of the plate are shares of its amplitudes, with cos kθ and -sin kθ

        ValueError if the columns have several shapes, or another one than the table.

        Examples
        --------
        >>> parameters = parameter_table(Conveyor(), z0=[0.0, 3e-4])
        >>> frame = classify(parameters).to_frame(parameters)
        >>> frame[["z0", "state", "period"]].values.tolist()
        [[0.0, 'first', 1], [0.0003, 'second', 1]]
        """
        try:
            import pandas
        except ModuleNotFoundError as error:
            raise ModuleNotFoundError(
                "to_frame needs pandas; install it by pip install pandas", name="pandas"
            ) from error
        columns = dict(self)
        if parameters is not None:
            names = getattr(parameters, "dtype", np.dtype(float)).names
            if names is None:
                raise TypeError(f"parameters must be a table from parameter_table, got {type(parameters).__name__}")
            inputs = {name: parameters[name] for name in names if name != "harmonics"}
            waves = np.moveaxis(parameters["harmonics"], -1, 0) if "harmonics" in names else ()
            inputs |= {f"harmonic_{1 + k // len(WAVES)}_{WAVES[k % len(WAVES)]}": wave for k, wave in enumerate(waves)}
            columns = inputs | columns
        if len({array.shape for array in columns.values()}) > 1:
            shapes = f" and parameters {parameters.shape}" if parameters is not None else ""
            raise ValueError(f"{self!r}{shapes} have no common shape")
        return pandas.DataFrame({name: np.reshape(array, -1) for name, array in columns.items()})
