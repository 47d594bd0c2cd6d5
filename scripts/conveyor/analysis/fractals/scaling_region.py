"""The scaling region of a fractal: its dimension as a slope, with an error bar.

Both estimators, box_counting and correlation_sum, give a curve of log(measure) over log(scale). Its slope is the
dimension only in between: boxes smaller than the distance of the samples count samples, boxes as large as the set feel
its rim. `scaling_region` finds the scales in between.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ... import linear_algebra
from ...arguments import LARGEST_COORDINATE, check_array

COARSEST_SCALE = 0.25  # of the set's extent
FINEST_SCALE = 2.0**-20  # of the set's extent; samples closer than this count as one: a settled orbit repeats itself
SCALES_PER_OCTAVE = 4
SCALES = np.geomspace(COARSEST_SCALE, FINEST_SCALE, 18 * SCALES_PER_OCTAVE + 1)
SAMPLES_PER_BOX = 5.0  # with fewer, too many boxes stay empty by chance (e^-5 of them in a uniform set)
SHORTEST_REGION = 8.0  # ratio of the largest to the smallest scale
RIM_PENALTY = 1e-5  # (residual 0.01 / rim 3)²: keeps the rim's coefficient of order one
STRAIGHT = 2.0  # standard errors within which the curvature of a straight stretch vanishes
NEGLIGIBLE_DRIFT = 0.05  # of the slope from the middle to the ends: straight, whatever its standard error


class Dimension(NamedTuple):
    """Estimate of a dimension.

    Attributes
    ----------
    value, error : dimension and the half-width of its 95 % interval, in which scatter, finite sample and choice of the
        scaling region are included; NaN if the points resolve no three octaves
    scale_low, scale_high : limits of the scaling region, in units of the set's extent
    scales : box sizes or radii that the points resolve, descending, in units of the set's extent, shape (k,)
    counts : mean number of occupied boxes, or share of pairs that are closer than the radius, shape (k,)
    """

    value: float
    error: float
    scale_low: float
    scale_high: float
    scales: np.ndarray
    counts: np.ndarray


def normalise(points: ArrayLike) -> np.ndarray:
    """The points, shape (n, 2), scaled axis by axis to the unit square; an axis without extent becomes zero.

    ValueError if the points have another shape, are none, or are not finite.
    """
    points = check_array("points", points, -LARGEST_COORDINATE, LARGEST_COORDINATE)
    if points.ndim != 2 or points.shape[1] != 2:
        raise ValueError(f"points must have the shape (n, 2), got {points.shape}")
    low, extent = points.min(axis=0), np.ptp(points, axis=0)
    return np.ascontiguousarray((points - low) / np.where(extent > 0.0, extent, 1.0))


def scaling_region(scales: np.ndarray, values: np.ndarray, uncertain: np.ndarray) -> tuple[float, float, float, float]:
    """Slope of `values` over log(scales), its error and the limits of the longest straight stretch.

    Every stretch of at least SHORTEST_REGION is fitted by a + s log ε + b ε. The last term is the rim, exact for
    smooth bodies (the Steiner formula gives (1 + ε)² boxes for a square); it is held to be of order one. A stretch is
    straight if a further term in (log ε)² is not significant or negligible; if none is, the straightest is taken.
    The longest straight stretch is chosen among those with at most twice the smallest standard error. Residuals
    oscillate (lacunarity), so that each octave counts as one observation.

    Parameters
    ----------
    scales : descending, shape (k,)
    values : logarithm of the measure, shape (k,)
    uncertain : independent changes of `values` within their 95 % interval, shape (u, k)

    Returns
    -------
    slope, error, low, high
        error: the root of the sum of squares of twice the standard error, twice the rms deviation of the straight
        stretches that are at least half as long, the drift of the slope to the ends of the stretch, and the slopes of
        the uncertain changes
    """
    x = np.log(scales)
    first, last = np.triu_indices(len(x))
    length = x[first] - x[last]
    enough = length >= np.log(SHORTEST_REGION) - 1e-9
    if not enough.any():
        return np.nan, np.nan, np.nan, np.nan
    first, last, length = first[enough], last[enough], length[enough]
    index = np.arange(len(x))
    inside = ((index >= first[:, None]) & (index <= last[:, None])).astype(np.float64)
    position = (x - 0.5 * (x[first] + x[last])[:, None]) / length[:, None]
    columns = [np.ones_like(position), position, np.broadcast_to(scales, position.shape), position**2]

    fit, fit_error = fit_stretches(columns[:3], inside, values)
    bent, bent_error = fit_stretches(columns, inside, values)
    slope, slope_error = fit[:, 1] / length, fit_error[:, 1] / length
    curvature = np.abs(bent[:, 3]) / bent_error[:, 3]
    straight = (curvature <= max(STRAIGHT, curvature.min())) | (np.abs(bent[:, 3]) <= NEGLIGIBLE_DRIFT * length)

    certain = straight & (slope_error <= 2.0 * slope_error[straight].min())
    best = np.flatnonzero(certain)[np.lexsort((slope_error[certain], -np.round(length[certain], 9)))[0]]
    rivals = certain & (length >= 0.5 * length[best])
    choice = np.sqrt(np.mean((slope[rivals] - slope[best]) ** 2))
    drift = bent[best, 3] / length[best]
    stretch = [column[best : best + 1] for column in columns[:3]]
    shifts = [fit_stretches(stretch, inside[best : best + 1], change)[0][0, 1] / length[best] for change in uncertain]
    error = np.sqrt(np.sum(np.square([2.0 * slope_error[best], 2.0 * choice, drift, *shifts])))
    return slope[best], error, scales[last[best]], scales[first[best]]


def fit_stretches(columns: list[np.ndarray], inside: np.ndarray, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Least squares on each row's stretch: coefficients and standard errors, shape (stretches, columns)."""
    design = np.stack(columns, axis=-1) * inside[..., None]
    normal = linear_algebra.product(np.swapaxes(design, 1, 2), design)
    normal[:, 2, 2] += RIM_PENALTY
    inverse = linear_algebra.inverse_of_positive(normal)
    projected = np.sum(design * values[:, None], axis=1)
    coefficients = linear_algebra.dot(inverse, projected[:, None, :])
    residuals = inside * values - linear_algebra.dot(design, coefficients[:, None, :])
    freedom = np.maximum(inside.sum(axis=1) - len(columns), 1.0)
    variance = SCALES_PER_OCTAVE * np.sum(residuals**2, axis=1) / freedom
    return coefficients, np.sqrt(variance[:, None] * np.diagonal(inverse, axis1=1, axis2=2))
