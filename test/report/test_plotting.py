"""Figures of reports: files of the promised size, and the backend of the program untouched."""

import subprocess
import sys

from matplotlib.image import imread
import numpy as np
import pytest

from ins_sim.report import plotting


def test_a_figure_has_the_promised_pixels(tmp_path):
    """Width and height are in inches."""
    figure = plotting.new_figure(4, 3)
    figure.subplots().plot([0.0, 1.0], [0.0, 1.0])
    plotting.save_png(figure, tmp_path / 'figure.png')
    assert imread(tmp_path / 'figure.png').shape[:2] == (3 * plotting.DPI, 4 * plotting.DPI)


@pytest.mark.parametrize('length', [0, 1, plotting.MOST_POINTS, plotting.MOST_POINTS + 1,
                                    2 * plotting.MOST_POINTS - 1, 10 * plotting.MOST_POINTS + 7])
def test_points_are_thinned_evenly(length):
    """The first point stays, the rest are at one distance, and fewer than twice MOST_POINTS."""
    left = plotting.thinned(np.arange(length))
    assert len(left) < 2 * plotting.MOST_POINTS
    assert len(set(np.diff(left).tolist())) <= 1
    assert left[:1].tolist() == [0][:length]


def test_the_backend_of_the_program_stays():
    """A notebook that imports the reports keeps its inline plots: pyplot's backend is its own."""
    code = ('import matplotlib\n'
            'matplotlib.use("svg")\n'
            'import ins_sim.report.runs.aided_charts, ins_sim.report.charts.png\n'
            'import ins_sim.report.studies.tuned_gyro, ins_sim.report.runs.page\n'
            'import ins_sim.report.studies.filters, ins_sim.report.navigation\n'
            'from ins_sim.report.plotting import new_figure\n'
            'new_figure(2, 2)\n'
            'print(matplotlib.get_backend())\n')
    run = subprocess.run([sys.executable, '-c', code], capture_output=True, text=True, check=True)
    assert run.stdout.strip() == 'svg'


@pytest.mark.parametrize('title', ['d\udce9sk.csv', 'a$b_\\frac$c', '$x^$'])
def test_a_name_of_any_bytes_is_drawn(title, tmp_path):
    """Names that are no UTF-8 or hold a dollar; before, the figure failed after everything."""
    figure = plotting.new_figure(3, 2)
    figure.suptitle(title)
    figure.add_subplot().plot([0, 1], label=title)
    figure.axes[0].legend()
    plotting.save_png(figure, tmp_path / 'figure.png')
    assert (tmp_path / 'figure.png').read_bytes()[:4] == b'\x89PNG'
