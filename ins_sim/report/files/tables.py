"""Write histories as CSV tables with the column names of the DataFrames."""

from ins_sim.core.timeseries.named_columns import history_columns
from ins_sim.io.csv_writer import write_rows


def write_table(path, history):
    """
    Write a History as CSV: t_ns in integer nanoseconds, and one column per component.

    Each number is written as the shortest text that restores its bits.
    """
    write_rows(path, ('t_ns', *history_columns(history[:0])),
               ((block.t_ns, *history_columns(block).values()) for block in history.blocks()))


def write_tables(folder, records):
    """Write <name>.csv into a folder for each of {name: History}."""
    for name, history in records.items():
        write_table(folder / f'{name}.csv', history)
