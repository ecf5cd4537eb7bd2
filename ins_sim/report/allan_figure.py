"""The figure of an Allan deviation: the axes, the fit, and a guide for each coefficient."""

import numpy as np

from .noise_terms import TRIADS
from .plotting import literal, new_figure, save_png

COLOURS = {'x': 'tab:red', 'y': 'tab:green', 'z': 'tab:blue'}
GUIDES = {'Q': ':', 'N': '--', 'B': '-.', 'K': (0, (6, 2))}


def save_figure(path, title, noise):
    """Save the Allan deviations of a Noise, its fit and its guides as PNG."""
    terms = TRIADS[noise.triad]
    unit, si = next((t.unit, t.si) for t in terms if t.symbol == 'B')
    tau, deviation = noise.allan.tau_s, noise.allan.deviation / si
    figure = new_figure(9, 6.5)
    axes = figure.subplots()
    for axis, channel in zip(noise.axes, deviation.T):
        axes.loglog(tau, channel, '.-', ms=5, lw=0.8, color=COLOURS[axis], label=f'axis {axis}')
    fitted = np.sqrt(noise.together.deviation(tau) ** 2 + noise.known)
    axes.loglog(tau, fitted / si, 'k-', lw=1.5, label='fit to all axes')
    span = np.geomspace(tau[0], tau[-1], 60)
    guides = noise.together.parts(span).T / si
    low, high = deviation.min() / 2.0, deviation.max() * 2.0
    for term, row, guide in zip(terms, noise.rows(), guides):
        if row['all'] is not None:
            axes.loglog(span, guide, color='0.35', lw=1.0, ls=GUIDES[term.symbol],
                        label=f'{term.symbol} {row["all"]:.4g} {term.unit}, slope {term.slope}')
    axes.set_ylim(low, high)
    axes.set_xlabel('averaging time tau [s]')
    axes.set_ylabel(f'Allan deviation [{unit}]')
    axes.grid(which='major', alpha=0.5)
    axes.grid(which='minor', alpha=0.15)
    axes.legend(fontsize='small')
    axes.set_title(literal(f'{noise.triad}: {title}'))
    save_png(figure, path)
