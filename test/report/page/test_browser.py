"""Reports in a real browser, at the widths of a desktop and of a telephone."""

from support.aided.runs import command
from support.reports.browser import find_browser, seen
from support.reports.charts import every_mark
from ins_sim.report.page.content import Page, PageTable
from ins_sim.report.page.html import REPORT, write_page
import pytest

pytest.importorskip('bokeh')
# Width of the window, and a height that contains the complete report.
WINDOWS = ((1280, 5000), (400, 8000))


@pytest.fixture(scope='module')
def run(tmp_path_factory):
    """Return the folder of an aided flight of 90 s."""
    folder = tmp_path_factory.mktemp('flight')
    assert command(folder) == 0
    return folder / 'run'


def check(found, width, panels):
    """
    Check that every panel is drawn within the window, nothing is loaded, and no error occurs.
    """
    assert found['heard'] == []
    assert found['loaded'] == []
    assert found['width'] == width and found['scroll'] <= width
    assert len(found['plots']) == panels
    for plot in found['plots']:
        assert 0.0 <= plot['left'] and plot['right'] <= width and plot['height'] >= 100.0
        # Pixels of axes and curves; an empty canvas has one colour.
        assert plot['colours'] > 3
    for entry in found['legends']:
        assert entry['right'] <= width and entry['size'] >= 12.0


@pytest.mark.parametrize('width, height', WINDOWS)
def test_the_report_of_a_run_is_seen(run, width, height, tmp_path):
    """The report shows both solutions and the track; panels of one axis are zoomed together."""
    found = seen(run / REPORT, width, height, tmp_path, 'run')
    # Position, velocity, tilt, azimuth and NIS; position, attitude and drift; the track.
    check(found, width, 5 + 3 + 1)
    aided, strapdown = found['starts'][:5], found['starts'][5:8]
    assert aided == [aided[0]] * 5 and strapdown == [strapdown[0]] * 3
    assert aided[0] == pytest.approx(strapdown[0] + 1.0)
    texts = [entry['text'] for entry in found['legends']]
    assert {'east', 'north', '3 sigma east', 'no GNSS', 'aided solution', 'truth'} <= set(texts)


@pytest.mark.slow
@pytest.mark.parametrize('width, height', WINDOWS)
def test_every_mark_is_seen(width, height, tmp_path):
    """Every kind of mark of a chart is drawn in one report."""
    charts = every_mark()
    write_page(tmp_path, Page(
        'Every mark', 'All is seen.', charts,
        (PageTable('A wide table', tuple(f'column {k}' for k in range(12)),
                   ((1.0,) * 12, ('word' * 5,) * 12)),)))
    found = seen(tmp_path / REPORT, width, height, tmp_path, 'marks')
    check(found, width, sum(len(chart.panels) for chart in charts))


@pytest.mark.slow
def test_without_bokeh_the_images_are_seen(tmp_path, without_bokeh):
    """Without Bokeh the page contains the figures as images, within the window."""
    charts = every_mark()
    write_page(tmp_path, Page('Every mark', 'All is seen.', charts))
    found = seen(tmp_path / REPORT, 400, 8000, tmp_path, 'images')
    assert found['heard'] == [] and found['scroll'] <= 400
    assert len(found['images']) == len(charts)
    assert all(width > 400 and right <= 400 for width, right in found['images'])


def test_a_missing_browser_is_a_failure_in_ci_alone(monkeypatch):
    """Without a browser the test is skipped with what it looked for, and in CI it fails."""
    monkeypatch.setattr('support.reports.browser.NAMES', ('no-such-browser',))
    for value, outcome in (('true', pytest.fail.Exception), ('', pytest.skip.Exception)):
        monkeypatch.setenv('CI', value)
        with pytest.raises(outcome, match='no browser: none of no-such-browser is in the PATH'):
            find_browser()
