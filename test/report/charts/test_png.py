"""Charts as PNG: of a given size, for any text, with the same bytes each time."""

from io import BytesIO
import subprocess
import sys

from ins_sim.report.charts.chart import Chart, Curve, LOG, Panel
from ins_sim.report.charts.png import chart_png, DPI, save_chart, WIDTH
from ins_sim.report.charts.scales import LENGTHS, scale, TIMES
from matplotlib.image import imread
import numpy as np
import pytest
from support.reports.charts import every_mark


@pytest.mark.parametrize('chart', every_mark(), ids=lambda chart: chart.name)
def test_every_mark_is_drawn(chart, tmp_path):
    """Every mark is drawn in a picture of ten inches; drawing twice gives equal bytes."""
    path = save_chart(tmp_path, chart)
    assert path == tmp_path / f'{chart.name}.png'
    pixels = imread(path)
    assert pixels.shape[1] == WIDTH * DPI and len(pixels) >= 200
    assert len(np.unique(pixels.reshape(-1, pixels.shape[2]), axis=0)) > 20
    assert path.read_bytes() == chart_png(chart)


@pytest.mark.parametrize('words', ['d\udce9sk.csv', 'a$b_\\frac$c', '$x^$', '<b>&', 'x' * 300])
def test_texts_of_any_kind_are_drawn(words):
    """Names that are not UTF-8, text that looks like a formula, and long text are drawn."""
    curve = Curve(np.arange(3.0), np.arange(3.0), words)
    chart = Chart('x', words, (Panel((curve,), words, words, title=words, note=words),),
                  caption=words)
    assert imread(BytesIO(chart_png(chart))).shape[1] == WIDTH * DPI


@pytest.mark.parametrize('values', [[], [np.nan] * 3, [0.0] * 3, [-1.0, -2.0, -3.0]])
@pytest.mark.parametrize('axis', ['linear', LOG])
def test_a_curve_without_values_is_an_empty_panel(values, axis):
    """Without finite values, or with negative ones on a logarithmic axis, a panel is drawn."""
    curve = Curve(np.arange(len(values)) + 1.0, np.array(values), 'curve')
    chart_png(Chart('x', 'x', (Panel((curve,), 'x', 'y', x_scale=axis, y_scale=axis),)))


@pytest.mark.parametrize('units, largest, unit', [
    (LENGTHS, 9999.0, 'm'), (LENGTHS, 1e4, 'km'), (LENGTHS, 0.05, 'mm'), (LENGTHS, 0.0, 'mm'),
    (TIMES, 90.0, 's'), (TIMES, 3600.0, 'min'), (TIMES, 2e4, 'h')])
def test_units_fit_the_size(units, largest, unit):
    """Kilometres are used where metres would have five digits."""
    assert scale(units, largest)[1] == unit


def test_the_backend_of_the_program_stays():
    """Importing the reports keeps the backend of pyplot, so that a notebook keeps inline plots."""
    code = ('import matplotlib\n'
            'matplotlib.use("svg")\n'
            'import ins_sim.report.runs.page, ins_sim.report.navigation\n'
            'from ins_sim.report.charts.chart import Chart, Level, Panel\n'
            'from ins_sim.report.charts.png import chart_png\n'
            'chart_png(Chart("x", "x", (Panel((Level(0.0),), "x", "y"),)))\n'
            'print(matplotlib.get_backend())\n')
    run = subprocess.run([sys.executable, '-c', code], capture_output=True, text=True, check=True)
    assert run.stdout.strip() == 'svg'
