# SPDX-License-Identifier: BSD-3-Clause
"""How far order reaches in dense discs: what decides between liquid, hexatic and solid.

All functions take recorded frames: one, a list, or `run.frames` with any slice. The box must be
periodic all round. Functions of the orientation need frames with the field `psi6`
(`output.trajectory.fields`), and those of neighbourhoods need scipy. Errors are one standard error
by jackknife over eight groups of consecutive frames, so they allow for frames that remember each
other within a group; they are nan where there are fewer than eight frames.

    orientation        angle of the crystal's rows, and |psi6| of the whole sample
    bond_correlation   g6(r), how far bonds keep their directions
    wave_correlation   how far discs keep step with the waves of the crystal
    positional_order   g(x, 0), the pair correlation along the rows
    structure_map      S(kx, ky) around a first peak
    local_packing      packing in circles at points of a grid
    cell_packing       packing of the Voronoi cell of each disc
    block_order        moments, susceptibility and cumulant of psi6 in parts of the box
    maxima             the envelope of an oscillation
    decay              the exponent of a power law between two distances
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from carrom.adapters import package
from carrom.disc_arrays import Array, DiscArrays
from carrom.melting_neighbourhoods import cell_packing, local_packing
from carrom.melting_parts import (
    Given,
    jackknife,
    lattice_constant,
    listed,
    present,
    with_images,
)
from carrom.physics import Measured

__all__ = [
    "block_order",
    "bond_correlation",
    "cell_packing",
    "decay",
    "lattice_constant",
    "local_packing",
    "maxima",
    "orientation",
    "positional_order",
    "structure_map",
    "wave_correlation",
]


class Orientation(NamedTuple):
    """How a sample is turned: the rows are at `angle` + k pi / 3."""

    angle: float
    order: float


class Curve(NamedTuple):
    """A function of distance: middles of bins, values, and one standard error of each."""

    r: Array
    value: Array
    error: Array


class StructureMap(NamedTuple):
    """S at the box's wave vectors (kx[i], ky[j]), radians per length; `s` is (kx, ky)."""

    kx: Array
    ky: Array
    s: Array


class BlockOrder(NamedTuple):
    """Psi6 of the discs in a part of the box, the mean over parts and frames.

    Attributes:
        parts: the box is cut into parts * parts equal blocks
        length: the shorter side of a block
        discs: mean number of discs in a block
        order: mean of the modulus of Psi6
        square: mean of its square
        susceptibility: `discs` times (square - order^2)
        cumulant: 1 - <|Psi6|^4> / (2 <|Psi6|^2>^2): 1/2 in an ordered block, 0 in a large liquid
    """

    parts: int
    length: float
    discs: float
    order: Measured
    square: Measured
    susceptibility: Measured
    cumulant: Measured


def orientation(frames: Given) -> Orientation:
    """Return how the sample is turned, from the mean of psi6 over discs and frames.

    The angle is that of the bonds between neighbours, in radians from -pi/6 to pi/6, against the x
    axis. It means little where `order`, the modulus of the mean, is not far above 1 / sqrt(N).
    """
    mean = complex(np.mean([_mean_psi6(frame) for frame in listed(frames, "orientation")]))
    return Orientation(math.atan2(mean.imag, mean.real) / 6, abs(mean))


def bond_correlation(frames: Given, reach: float | None = None) -> Curve:
    """Return g6(r), the mean over pairs of the real part of psi6* psi6, in bins of one row each.

    In a hexatic it falls as r^(-a) with a of at most 1/4, in a solid it stays finite, and in a
    liquid it falls exponentially. The table `psi6_correlation` of a run has it in any bins.

    Args:
        frames: frames with positions and psi6
        reach: the largest distance; by default a quarter of the shorter side of the box
    """
    given = listed(frames, "bond_correlation")
    edges = _row_edges(given[0], reach)
    curves = [_field_correlation(frame, frame.psi6[frame.present], edges) for frame in given]
    value, error = jackknife(np.array(curves), lambda mean: mean)
    return Curve((edges[1:] + edges[:-1]) / 2, value, error)


def wave_correlation(frames: Given, reach: float | None = None) -> Curve:
    """Return the mean over pairs of cos(G (r - r')), in bins of one row each.

    G is a shortest reciprocal vector of the crystal: the box's wave vector of the highest S in each
    of three directions that the orientation gives. The mean is over these. In a solid it falls as
    r^(-a) with a of at most 1/3 where the solid melts (D. R. Nelson and B. I. Halperin, Phys. Rev.
    B 19, 2457 (1979)), and in a hexatic exponentially. Unlike the maxima of g(x, 0) - 1 it has no
    higher harmonics, which make these fall faster at short distances.

    Args:
        frames: frames with positions and psi6
        reach: the largest distance; by default a quarter of the shorter side of the box
    """
    given = listed(frames, "wave_correlation")
    edges = _row_edges(given[0], reach)
    curves = []
    for frame in given:
        waves = [_peak_of(frame, math.pi / 6 + k * math.pi / 3) for k in range(3)]
        fields = [np.exp(1j * (present(frame) @ wave)) for wave in waves]
        curves.append(np.mean([_field_correlation(frame, f, edges) for f in fields], axis=0))
    value, error = jackknife(np.array(curves), lambda mean: mean)
    return Curve((edges[1:] + edges[:-1]) / 2, value, error)


def positional_order(
    frames: Given, reach: float | None = None, bins: int = 200, width: float | None = None
) -> Curve:
    """Return the pair correlation g(x, 0) along the three rows of the crystal, (bins,).

    Pairs count that are at most `width` / 2 off the row. Each frame is turned by its own psi6, as
    in Bernard and Krauth, Phys. Rev. Lett. 107, 155704 (2011). In a solid the maxima of g - 1 fall
    as a power of the distance, at most as fast as r^(-1/3); in a hexatic and a liquid they fall
    exponentially. `decay` fits the power.

    Args:
        frames: frames with positions and psi6
        reach: the largest distance; by default a quarter of the shorter side of the box. Beyond
            some third of it the images of the box add order of their own.
        bins: of equal length, from 0 to `reach`
        width: of the row; by default a quarter of the mean distance of neighbours

    Cost: about a second for each frame of 16,384 discs.
    """
    given = listed(frames, "positional_order")
    first = given[0]
    spacing = lattice_constant(first)
    far = _reach(first, reach)
    across = spacing / 4 if width is None else float(width)
    edges = np.linspace(0, far, bins + 1)
    curves = np.array([_along_rows(frame, edges, across) for frame in given])
    value, error = jackknife(curves, lambda mean: mean)
    return Curve((edges[1:] + edges[:-1]) / 2, value, error)


def structure_map(
    frames: Given, span: float | None = None, direction: float | None = None
) -> StructureMap:
    """Return S(kx, ky), the mean over frames, in a square around the first peak of a crystal.

    Vectors are those of the box, k = 2 pi (n / Lx, m / Ly), and no other fits a periodic box.

    Args:
        frames: frames with positions
        span: the side of the square, radians per length; by default half the length of k
        direction: angle of the peak's wave vector; by default that of the first frame's
            orientation plus 90 degrees, which needs psi6
    """
    given = listed(frames, "structure_map")
    first = given[0]
    k = 4 * math.pi / (math.sqrt(3) * lattice_constant(first))
    side = k / 2 if span is None else float(span)
    angle = orientation(first).angle + math.pi / 2 if direction is None else float(direction)
    middle = (k * math.cos(angle), k * math.sin(angle))
    waves = [_box_vectors(middle[axis], side, float(first.box[axis])) for axis in (0, 1)]
    total = np.zeros((len(waves[0]), len(waves[1])))
    for frame in given:
        x = present(frame)
        modes = np.exp(1j * np.outer(waves[0], x[:, 0])) @ np.exp(1j * np.outer(x[:, 1], waves[1]))
        total += np.abs(modes) ** 2 / len(x)
    return StructureMap(waves[0], waves[1], total / len(given))


def block_order(frames: Given, parts: Sequence[int] = (1, 2, 4, 8)) -> list[BlockOrder]:
    """Return the moments of psi6 in blocks of the box, one row for each number of parts.

    Psi6 of a block is the mean of psi6 over the discs in it. Its susceptibility and cumulant
    in blocks of several lengths show where order begins without runs of other sizes: H. Weber,
    D. Marx and K. Binder, Phys. Rev. B 51, 14636 (1995).
    """
    given = listed(frames, "block_order")
    return [_block_order(given, count) for count in parts]


def decay(
    r: npt.ArrayLike,
    values: npt.ArrayLike,
    between: tuple[float, float],
    spacing: float | None = None,
) -> Measured:
    """Return the exponent a of values ~ r^(-a) between two distances, by least squares of logs.

    Args:
        r: distances
        values: above 0 where they are fitted, as g6(r), or g(x, 0) - 1 with `spacing`
        between: the shortest and the longest distance
        spacing: if given, only `maxima` count

    Returns:
        The exponent with the error of the fit, from the scatter about it. Neighbouring values
        of one run vary together, so the scatter between runs is larger.
    """
    x, y = np.asarray(r, dtype=np.float64), np.asarray(values, dtype=np.float64)
    if spacing is not None:
        x, y = maxima(x, y, spacing)
    chosen = (x >= between[0]) & (x <= between[1])
    x, y = x[chosen], y[chosen]
    if len(x) < 3 or not np.all(y > 0):
        raise ValueError("decay: fewer than three values between the distances, or one is not > 0")
    logs = np.log(x) - np.log(x).mean()
    slope = (logs @ np.log(y)) / (logs @ logs)
    rest = np.log(y) - np.log(y).mean() - slope * logs
    return Measured(-float(slope), math.sqrt((rest @ rest) / (len(x) - 2) / (logs @ logs)))


def maxima(r: npt.ArrayLike, values: npt.ArrayLike, spacing: float) -> tuple[Array, Array]:
    """Return where values are largest, one for each multiple of `spacing`: an envelope.

    Each multiple has the distances that are nearest to it, as each disc of a row has its own.
    """
    x, y = np.asarray(r, dtype=np.float64), np.asarray(values, dtype=np.float64)
    nearest = np.round(x / spacing).astype(int)
    best = [k[np.argmax(y[k])] for k in (np.flatnonzero(nearest == n) for n in np.unique(nearest))]
    return x[best], y[best]


def _mean_psi6(frame: DiscArrays) -> complex:
    return complex(frame.psi6[frame.present].mean(dtype=np.complex128))


def _reach(frame: DiscArrays, reach: float | None) -> float:
    most = float(min(frame.box)) / 2
    far = most / 2 if reach is None else float(reach)
    if not 0 < far <= most:
        raise ValueError(f"reach is above 0 and at most half the shorter side of the box, {most:g}")
    return far


def _row_edges(frame: DiscArrays, reach: float | None) -> Array:
    """Edges of bins about the distances of the discs of a row."""
    spacing = lattice_constant(frame)
    return (np.arange(math.floor(_reach(frame, reach) / spacing - 0.5) + 1) + 0.5) * spacing


def _peak_of(frame: DiscArrays, direction: float) -> Array:
    """The wave vector of the highest S near a direction against the rows."""
    found = structure_map(frame, direction=orientation(frame).angle + direction)
    i, j = np.unravel_index(np.argmax(found.s), found.s.shape)
    return np.array([found.kx[i], found.ky[j]])


def _field_correlation(frame: DiscArrays, field: Array, edges: Array) -> Array:
    """The mean over pairs of the real part of field* field, in bins of distance.

    Discs and field are summed in cells, of a quarter of a row or less, and Fourier transforms give
    all products. So distances are those of cells, which means nothing to bins as long as a row.
    """
    cells = np.ceil(4 * frame.box / lattice_constant(frame)).astype(int)
    index = np.minimum((present(frame) / frame.box * cells).astype(int), cells - 1)
    ways = [np.minimum(np.arange(n), n - np.arange(n)) / n for n in cells]
    r = np.hypot(ways[0][:, None] * frame.box[0], ways[1] * frame.box[1])
    sums = []
    for values in (np.ones(len(index)), field):
        grid = np.zeros(cells, dtype=np.complex128)
        np.add.at(grid, tuple(index.T), values)
        products = np.fft.ifft2(np.abs(np.fft.fft2(grid)) ** 2).real
        sums.append(np.histogram(r, edges, weights=products)[0])
    return np.asarray(sums[1] / sums[0])


def _along_rows(frame: DiscArrays, edges: Array, across: float) -> Array:
    """g(x, 0) of one frame: pairs in a strip along each row, over an ideal gas's number."""
    spatial = package("scipy.spatial", "positional_order", "scipy")
    x = present(frame)
    far, half = edges[-1], across / 2
    around = with_images(x, frame.box, math.hypot(far, half))
    turned = orientation(frame).angle
    counts = np.zeros(len(edges) - 1)
    for k in range(3):
        along = np.array([math.cos(turned + k * math.pi / 3), math.sin(turned + k * math.pi / 3)])
        # In these coordinates the strip is a square, and pairs within 1 are those in it.
        axes = np.stack([along / far, np.array([-along[1], along[0]]) / half], axis=1)
        own, all_discs = spatial.cKDTree(x @ axes), spatial.cKDTree(around @ axes)
        pairs = own.sparse_distance_matrix(all_discs, 1, p=np.inf, output_type="ndarray")
        ways = np.abs((around[pairs["j"]] - x[pairs["i"]]) @ along)
        counts += np.histogram(ways[pairs["i"] != pairs["j"]], edges)[0]
    ideal = 3 * len(x) * (len(x) - 1) / float(np.prod(frame.box)) * 2 * across * np.diff(edges)
    return np.asarray(counts / ideal)


def _box_vectors(middle: float, side: float, length: float) -> Array:
    unit = 2 * math.pi / length
    first, last = math.ceil((middle - side / 2) / unit), math.floor((middle + side / 2) / unit)
    return unit * np.arange(first, last + 1)


def _block_order(given: list[DiscArrays], parts: int) -> BlockOrder:
    moments = np.array([_moments(frame, parts) for frame in given])
    discs = float(np.mean([np.count_nonzero(f.present) for f in given])) / parts**2

    def measured(number: Callable[[Array], Any]) -> Measured:
        value, error = jackknife(moments, number)
        return Measured(float(value), float(error))

    return BlockOrder(
        parts,
        float(min(given[0].box)) / parts,
        discs,
        measured(lambda m: m[0]),
        measured(lambda m: m[1]),
        measured(lambda m: discs * (m[1] - m[0] ** 2)),
        measured(lambda m: 1 - m[2] / (2 * m[1] ** 2)),
    )


def _moments(frame: DiscArrays, parts: int) -> Array:
    """Means over blocks of the first, second and fourth power of |Psi6|; empty ones left out."""
    cells = np.minimum((present(frame) / frame.box * parts).astype(int), parts - 1)
    block = cells[:, 0] * parts + cells[:, 1]
    psi6 = frame.psi6[frame.present].astype(np.complex128)
    n = np.bincount(block, minlength=parts**2)
    sums = [np.bincount(block, part, parts**2) for part in (psi6.real, psi6.imag)]
    modulus = np.hypot(*sums)[n > 0] / n[n > 0]
    return np.array([np.mean(modulus**power) for power in (1, 2, 4)])
