"""Write the study of delays: figures, tables of their curves, numbers and page."""

import json

from ..charts.png import save_chart
from ..page.html import write_page
from ..runs.kml import FILE as TRACKS, write_tracks
from ..runs.track import Track
from . import delay_data, delay_names
from .delays import study_charts, study_page, study_tables, TITLE

MARK = 'delay_study.json'


def write_study(folder, results):
    """Write FigureResults into a folder; return the PageTables."""
    tables, charts = study_tables(results), study_charts(results)
    files = {MARK: 'the numbers of the tables'}
    for result in results:
        files.update(dict.fromkeys(delay_data.save_csv(folder, result),
                                   f'the curves of {result.figure.name}'))
    for chart in charts:
        save_chart(folder, chart)
        files[f'{chart.name}.png'] = 'a figure'
    tracks = [Track(delay_names.motion_name(run.settings), *run.track.T) for result in results
              if result.figure.shows.figure == 'flight' for run in result.runs]
    if tracks:
        write_tracks(folder, TITLE, tracks)
        files[TRACKS] = 'the tracks of the flights'
    (folder / MARK).write_text(json.dumps({
        'figures': [delay_data.figure_numbers(result) for result in results],
        'runs': [delay_data.run_numbers(run) for run in delay_data.all_runs(results)]},
        indent=1) + '\n', encoding='utf-8')
    write_page(folder, study_page(results, charts, tables, files))
    return tables
