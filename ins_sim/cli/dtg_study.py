"""Verb dtg-study: both tables, both figures and both stability limits of the DTG paper."""

from pathlib import Path

import numpy as np
from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn

from ..core import dtg_study as study
from ..report import dtg_study as report

CURVE_POINTS = 13


def run(chosen):
    """Compute, show and save; return the exit code."""
    folder = Path(chosen.output)
    folder.mkdir(parents=True, exist_ok=True)
    console = Console()
    limits = study.stability_limits()
    rates = np.geomspace(0.5, 8.0, CURVE_POINTS).tolist()
    speeds = np.linspace(limits[0] + 1.0, limits[1] - 1.0, CURVE_POINTS).tolist()
    jobs = (('base frequency', study.frequency_table, {}),
            ('rotor speed', study.speed_table, {}),
            ('curve over frequency', study.frequency_table, {'rates_rad_s': rates}),
            ('curve over speed', study.speed_table, {'speeds_hz': speeds}))
    results = []
    with Progress(TextColumn('{task.description}'), BarColumn(),
                  TextColumn('{task.completed:.0f} of {task.total:.0f}'), console=console,
                  transient=True) as progress:
        for name, table, arguments in jobs:
            task = progress.add_task(name, total=CURVE_POINTS)
            results.append(table(progress=lambda done, total, task=task: progress.update(
                task, completed=done, total=total), **arguments))
    by_rate, by_speed, rate_curve, speed_curve = results
    report.show('rotor at 230 Hz', 'base [rad/s]', by_rate, console)
    report.show('base at 1 rad/s', 'rotor [Hz]', by_speed, console)
    console.print('RK4 at 0.75 ms is stable from {:.1f} to {:.1f} Hz; the paper: {:g} to {:g} Hz'
                  .format(*limits, *study.PAPER_LIMITS_HZ))
    for name, label, curve, table, lines in (
            ('frequency', 'base frequency [rad/s]', rate_curve, by_rate, ()),
            ('speed', 'rotor speed [Hz]', speed_curve, by_speed, limits)):
        path = folder / f'error_over_{name}.png'
        report.save_figure(path, label, curve, table, study.AMPLITUDE_DEG, lines)
        console.print(f'figure: {path}')
    return 0
