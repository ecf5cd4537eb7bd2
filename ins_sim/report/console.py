"""The console of the verbs: words as they are, tables whole, however wide the terminal is."""

import os
import sys

from rich.console import Console
from rich.measure import Measurement
from rich.table import Table

from ins_sim.visible_text import visible

# wider than any table
WIDEST = 10000


class PlainConsole(Console):
    """
    A console that shows every text as it is: no markup, and nothing that a terminal obeys.

    Lines are never wrapped, and no number of a table is ever cut: in a terminal names are folded
    where the table is too wide, elsewhere nothing is.
    """

    def __init__(self, **more):
        super().__init__(markup=False, highlight=False, emoji=False, soft_wrap=True, **more)

    def render_str(self, text, **more):
        """Return a text in which control characters are seen."""
        return super().render_str(visible(text, keep='\n\t'), **more)

    def on_broken_pipe(self):
        """Say no more: what is computed is still to be written."""
        self.quiet = True
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())

    def print(self, *objects, **more):
        """Print; a table gets the width that it needs."""
        if len(objects) == 1 and isinstance(objects[0], Table):
            # its own width counts where that of the console is less
            objects[0].width = self._width_of(objects[0])
            more = {'soft_wrap': False, 'crop': False, **more}
        super().print(*objects, **more)

    def _width_of(self, table):
        for column in table.columns:
            # what is aligned to the right are numbers
            column.no_wrap = column.no_wrap or column.justify == 'right'
            column.overflow = 'fold'
        least, most = Measurement.get(self, self.options.update(width=WIDEST), table)
        return max(least, min(most, self.width)) if self.is_terminal else most
