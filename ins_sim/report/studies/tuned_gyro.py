"""The study of the tuned-gyro paper in tables and figures."""

from rich.table import Table

from ins_sim.settings.tuned_gyro import SWEEPS
from ..plotting import new_figure, save_png


def study_title(settings):
    """Return a line that says what is constant in the study of TunedGyroStudySettings."""
    held = (f'rotors at {settings.rotor_speed_hz:g} Hz' if settings.sweep == 'base_rate' else
            f'base at {settings.base_rate_rad_s:g} rad/s')
    return (f'{settings.amplitude_deg:g} deg of roll, {held}, preset {settings.preset}, '
            f'{settings.method} at {settings.step_ms:g} ms')


def show_study(settings, cells, console):
    """Print the Cells of a table beside what the paper prints, where it does."""
    compared = any(cell.paper_deg is not None for cell in cells)
    table = Table(title=study_title(settings))
    for head in (SWEEPS[settings.sweep], 'Poisson [deg]', 'Euler vector [deg]',
                 *(('paper [deg]', 'ours - paper') if compared else ())):
        table.add_column(head, justify='right')
    for cell in cells:
        row = [f'{cell.value:g}', f'{cell.poisson_deg:.4f}', f'{cell.euler_vector_deg:.4f}']
        if compared:
            row += [f'{cell.paper_deg:g}', f'{cell.poisson_deg - cell.paper_deg:+.4f}']
        table.add_row(*row)
    console.print(table)


def show_limits(settings, limits, console):
    """Print between which speeds RK4 is stable; None is a side without a limit."""
    low, high = ('no limit' if limit is None else f'{limit:.1f}' for limit in limits)
    paper = settings.paper_limits_hz
    console.print(f'RK4 at {settings.step_ms:g} ms is stable from {low} to {high} Hz'
                  + ('; the paper: {:g} to {:g} Hz'.format(*paper) if paper else ''))


def save_figure(path, settings, curve, cells, limits=()):
    """
    Save the error of the amplitude over its cause as PNG.

    curve: Cells of a dense sweep; cells: those of the table, the paper's values drawn in as
    points; limits: speeds, Hz, at which the program of the paper becomes unstable.
    """
    figure = new_figure(8, 5)
    axes = figure.subplots()
    true_deg = settings.amplitude_deg
    axes.plot([c.value for c in curve], [c.poisson_deg - true_deg for c in curve],
              label='simulated')
    printed = [c for c in cells if c.paper_deg is not None]
    if printed:
        axes.plot([c.value for c in printed], [c.paper_deg - true_deg for c in printed], 'ko',
                  label='paper')
    label = 'limits of stability'
    for limit in limits:
        if limit is not None:
            axes.axvline(limit, color='tab:red', ls='--', lw=1, label=label)
            axes.annotate(f'{limit:.1f} Hz', (limit, 0.5), color='tab:red', rotation=90,
                          xycoords=('data', 'axes fraction'), va='center', ha='right')
            label = None
    axes.set_xlabel(SWEEPS[settings.sweep])
    axes.set_ylabel('error of the roll amplitude [deg]')
    axes.set_title(study_title(settings), fontsize='medium')
    axes.grid(alpha=0.3)
    axes.legend()
    save_png(figure, path)
