"""Windows over correlated sequences, and error bars of means over them by resampling blocks or whole sequences."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy import stats

from particles.errors import ParticleError, require
from particles.state import Floats

BLOCK_PER_WINDOW = 5  # length of a block over that of the longest window
FEWEST_BLOCKS = 10


def window_sums(increments: Floats, periods: int) -> Floats:
    """Sums of all windows of `periods` successive increments (n,), overlapping: (n - periods + 1,)."""
    running = np.concatenate([[0.0], np.cumsum(increments)])
    return running[periods:] - running[:-periods]


@dataclass(frozen=True, kw_only=True)
class Resampling:
    """Resampled means over the windows of several sequences, from blocks of windows that begin one after the other.

    A mean over windows is resampled by drawing as many blocks as lie side by side in all sequences together. A block is
    `BLOCK_PER_WINDOW` times the longest window, so that what a window shares with others, and the correlation of the
    increments over that length, stay within blocks. The same draws serve every quantity: differences between windows
    of different lengths keep their correlation.

    Of many sequences whole ones may be drawn instead (the bootstrap of clusters): right however long increments
    remember, and where sequences differ among themselves. Sequences without room for a block, or of whole ones for two
    windows side by side, do not count.

    Parameters
    ----------
    sequences : tuple of (n,)
        Independent sequences of increments per period [m].
    longest : int
        Periods of the longest window that will be asked for.
    block : int, optional
        Begins of windows per block; give more than the default where increments remember longer than that.
    whole : bool
        Draw whole sequences.
    resamples : int
    level : float
        Share of cases in which the true value should lie within the half widths.
    seed : int

    Raises
    ------
    ParticleError
        If the sequences hold fewer than `FEWEST_BLOCKS` blocks, or are fewer if drawn whole.
    """

    sequences: tuple[Floats, ...]
    longest: int
    block: int | None = None
    whole: bool = False
    resamples: int = 400
    level: float = 0.95
    seed: int = 1

    def __post_init__(self) -> None:
        require("windows", self.longest, at_least=1)
        require("resamples", self.resamples, at_least=20)
        if not 0.0 < self.level < 1.0:
            raise ParticleError(f"level = {self.level:g} must lie between 0 and 1")
        if self.whole and self.blocks < FEWEST_BLOCKS:
            raise ParticleError(
                f"{self.blocks} of {len(self.sequences)} sequences hold two windows of {self.longest} periods; error "
                f"bars from whole sequences need {FEWEST_BLOCKS}: take shorter windows, longer runs or more samples"
            )
        if self.blocks < FEWEST_BLOCKS:
            held = sum(len(sequence) for sequence in self.sequences)
            raise ParticleError(
                f"{held} periods in {len(self.sequences)} sequences make {self.blocks} blocks of {self.length} "
                f"windows of {self.longest} periods; error bars need {FEWEST_BLOCKS}: take shorter windows or longer "
                "runs"
            )

    @property
    def length(self) -> int:
        """Windows per block; the fewest of a whole sequence that counts."""
        if self.whole:
            return self.longest + 1
        return BLOCK_PER_WINDOW * self.longest if self.block is None else self.block

    @property
    def _held(self) -> list[int]:
        """Begins of windows in each sequence that has room for a block of them."""
        held = [len(sequence) - self.longest + 1 for sequence in self.sequences]
        return [count if count >= self.length else 0 for count in held]

    @property
    def blocks(self) -> int:
        """Blocks that lie side by side, or sequences to be drawn whole."""
        if self.whole:
            return sum(count > 0 for count in self._held)
        return sum(self._held) // self.length

    def sums(self, periods: int) -> list[Floats]:
        """Window sums of every sequence that counts, for windows not longer than the longest."""
        return [
            window_sums(sequence, periods)[:count]
            for sequence, count in zip(self.sequences, self._held, strict=True)
            if count
        ]

    def means(self, periods: int, quantity: Callable[[Floats], Floats]) -> tuple[Floats, Floats]:
        """Mean of a quantity of window sums, (n,) to (n, k), over all windows: (k,), and resampled (resamples, k)."""
        total, number, of_blocks, sizes = 0.0, 0, [], []
        for sums in self.sums(periods):
            values = quantity(sums)
            total, number = total + values.sum(axis=0), number + len(values)
            length = len(values) if self.whole else self.length
            running = np.concatenate([np.zeros((1, values.shape[1])), np.cumsum(values, axis=0)])
            of_blocks.append(running[length:] - running[:-length])
            sizes += [length] * len(of_blocks[-1])
        drawn, size = np.concatenate(of_blocks), np.array(sizes)
        places = np.random.default_rng(self.seed).integers(len(drawn), size=(self.resamples, self.blocks))
        return total / number, np.array([drawn[place].sum(axis=0) / size[place].sum() for place in places])

    def half_width(self, resampled: Floats) -> Floats:
        """Half width of the interval of the level, from resampled values (resamples, k): (k,).

        Student's factor for the number of blocks, and the standard deviation widened from that of a sample of as many.
        """
        factor = stats.t.ppf(0.5 * (1.0 + self.level), self.blocks - 1) * np.sqrt(self.blocks / (self.blocks - 1.0))
        return np.asarray(factor * resampled.std(axis=0))


def limit_weights(periods: Sequence[int], half_widths: Floats) -> Floats:
    """Weights (n,) of values at windows of `periods` in their limit of endless windows: the line over 1/n, at 0.

    Fitted with the half widths (n,) of the values.
    """
    certain = 1.0 / np.maximum(half_widths, 1e-6 * float(np.max(half_widths)))
    lines = np.column_stack([np.ones(len(certain)), 1.0 / np.asarray(periods, float)]) * certain[:, None]
    return np.asarray(np.linalg.pinv(lines)[0] * certain)


def checked_sequences(sequences: Sequence[Floats]) -> tuple[Floats, ...]:
    """Sequences as arrays of finite numbers, or a refusal."""
    arrays = tuple(np.asarray(sequence, float).ravel() for sequence in sequences)
    if not arrays:
        raise ParticleError("a large-deviation function needs a sequence of increments")
    for number, array in enumerate(arrays):
        if not np.isfinite(array).all():
            raise ParticleError(f"sequence {number} of increments holds what is not a finite number")
    return arrays
