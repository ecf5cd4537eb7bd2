"""Histories as CSV tables, whose columns have the names that DataFrames have."""

from ins_sim.core.timeseries.named_columns import history_columns
from ins_sim.io.csv_writer import write_rows


def write_table(path, history):
    """
    Write a History as CSV: t_ns, whole nanoseconds, and a column for each component.

    Each number stands in the shortest text that gives its bits back.
    """
    write_rows(path, ('t_ns', *history_columns(history[:0])),
               ((block.t_ns, *history_columns(block).values()) for block in history.blocks()))


def write_tables(folder, records):
    """Write <name>.csv into a folder for each of {name: History}."""
    for name, history in records.items():
        write_table(folder / f'{name}.csv', history)
