"""Console of the commands: prints text without markup and tables without cutting numbers."""

import os
import sys

from rich.console import Console
from rich.measure import Measurement
from rich.table import Table

from ins_sim.visible_text import visible

# Wider than any table.
WIDEST = 10000


class PlainConsole(Console):
    """
    A console that prints text literally: no markup, and control characters are escaped.

    Lines are not wrapped, and numbers in tables are never cut. If a table is too wide for a
    terminal, names are folded; in files and pipes nothing is folded.
    """

    def __init__(self, **more):
        super().__init__(markup=False, highlight=False, emoji=False, soft_wrap=True, **more)

    def render_str(self, text, **more):
        """Return a text with its control characters escaped."""
        return super().render_str(visible(text, keep='\n\t'), **more)

    def on_broken_pipe(self):
        """Stop printing but continue, because the results must still be written."""
        self.quiet = True
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())

    def print(self, *objects, **more):
        """Print objects; give a table the width that it needs."""
        if len(objects) == 1 and isinstance(objects[0], Table):
            # A width set on the table takes precedence over that of the console.
            objects[0].width = self._width_of(objects[0])
            more = {'soft_wrap': False, 'crop': False, **more}
        super().print(*objects, **more)

    def _width_of(self, table):
        for column in table.columns:
            # Right-aligned columns contain numbers, which must not be wrapped.
            column.no_wrap = column.no_wrap or column.justify == 'right'
            column.overflow = 'fold'
        least, most = Measurement.get(self, self.options.update(width=WIDEST), table)
        return max(least, min(most, self.width)) if self.is_terminal else most
