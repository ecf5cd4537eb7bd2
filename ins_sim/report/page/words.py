"""Texts and numbers as they stand in HTML."""

from html import escape
import math
import numbers
import re

from ins_sim.visible_text import visible

# Between the words of the name of a setting.
_JOINT = re.compile(r'(?<=[a-z])([._])(?=[a-z])')


def text(words):
    """Return a text as it stands in HTML: escaped, and what cannot be seen as escapes."""
    return escape(visible(str(words)))


def breakable(escaped):
    """Return a text in HTML that may be broken within names such as gyro.errors.bias_deg_h."""
    return _JOINT.sub(r'\1<wbr>', escaped)


def cell_text(value):
    """Return a cell of a table as text: a number with four digits, a dash for what is missing."""
    if value is None or isinstance(value, numbers.Real) and math.isnan(value):
        return '–'
    if isinstance(value, bool):
        return 'yes' if value else 'no'
    if isinstance(value, numbers.Integral):
        return str(int(value))
    if isinstance(value, numbers.Real):
        return f'{float(f"{value + 0.0:.4g}"):.10g}'
    return str(value)
