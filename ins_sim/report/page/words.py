"""Convert texts and numbers to HTML."""

from html import escape
import math
import numbers
import re

from ins_sim.visible_text import visible

# Matches the separators in the name of a setting.
_JOINT = re.compile(r'(?<=[a-z])([._])(?=[a-z])')


def text(words):
    """Return a text escaped for HTML, with invisible characters shown as escapes."""
    return escape(visible(str(words)))


def breakable(escaped):
    """Return HTML text with line-break opportunities in names such as gyro.errors.bias_deg_h."""
    return _JOINT.sub(r'\1<wbr>', escaped)


def cell_text(value):
    """Return a table cell as text: numbers with four digits, a dash for a missing value."""
    if value is None or isinstance(value, numbers.Real) and math.isnan(value):
        return '–'
    if isinstance(value, bool):
        return 'yes' if value else 'no'
    if isinstance(value, numbers.Integral):
        return str(int(value))
    if isinstance(value, numbers.Real):
        return f'{float(f"{value + 0.0:.4g}"):.10g}'
    return str(value)
