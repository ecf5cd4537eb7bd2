"""Quantities as text, in the unit of their size."""

import pytest

from ins_sim.report.charts.scales import amount, LENGTHS, TIMES


@pytest.mark.parametrize('units, value, text', [
    (LENGTHS, 1915.04, '1915 m'), (LENGTHS, -49.06, '-49.1 m'), (LENGTHS, 0.0123, '12.3 mm'),
    (LENGTHS, 0.0, '0 mm'), (LENGTHS, 63518.0, '63.5 km'), (TIMES, 10800.1, '3 h'),
    (TIMES, 3000.0, '50 min'), (TIMES, 99.9, '99.9 s')])
def test_three_digits_and_no_exponent(units, value, text):
    """A number with four digits before the point is printed in full, without an exponent."""
    assert amount(units, value) == text
