"""Frequency of an oscillation out of samples of it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from coupled.errors import QuantityError

Floats = NDArray[np.float64]
FEWEST_CROSSINGS = 3  # one period
PADDED = 8  # lengths of the window by which the spectrum is refined with zeros


def frequency_of(time: Floats, value: Floats, name: str) -> float:
    """Frequency [Hz] of ``a + exp(-d t) (b cos 2 pi f t + c sin 2 pi f t)`` that fits samples best.

    The peak of the spectrum is a first value, on which least squares improve in f and d; a, b and c are linear.

    Parameters
    ----------
    time, value : (n,)
        Ascending times [s] and samples; name is what they are called in the sentence.

    Raises
    ------
    QuantityError
        If fewer than one period is seen.
    """
    first = _strongest(time, value, name)
    scaled = (time - time[0]) * first  # in periods
    values = (value - value.mean()) / value.std()

    def misfit(asked: Floats) -> Floats:
        shapes = _shapes(scaled, *asked)
        return shapes @ np.linalg.lstsq(shapes, values, rcond=None)[0] - values

    fitted = least_squares(misfit, x0=[1.0, 0.0], x_scale=[1.0 / scaled[-1], 1.0 / scaled[-1]], xtol=1e-14, ftol=1e-14)
    return float(fitted.x[0] * first)


def _shapes(periods: Floats, frequency: float, decay: float) -> Floats:
    """The three functions (n, 3) that the fit adds up, at times counted in periods of the first guess."""
    fading, phase = np.exp(-decay * periods), 2.0 * np.pi * frequency * periods
    return np.column_stack([np.ones_like(periods), fading * np.cos(phase), fading * np.sin(phase)])


def _strongest(time: Floats, value: Floats, name: str) -> float:
    """Where the spectrum of the samples is largest [Hz], from half a period in the window on."""
    middle = 0.5 * (value.max() + value.min())
    crossings = int(np.count_nonzero((value[:-1] > middle) != (value[1:] > middle)))
    if crossings < FEWEST_CROSSINGS:
        raise QuantityError(f"{name} does not oscillate: it passes its middle {middle:g} {crossings} times only")
    even = np.linspace(time[0], time[-1], len(time))  # the last row may come early
    spectrum = np.abs(np.fft.rfft(np.interp(even, time, value - value.mean()), PADDED * len(even)))
    least = PADDED // 2
    return float((least + np.argmax(spectrum[least:])) / (PADDED * len(even) * (even[1] - even[0])))
