"""Values in messages are shortened, and remain distinguishable from bounds."""

import pytest

from ins_sim.settings.catalogue import build
from ins_sim.settings.navigate import NavigateSettings
from ins_sim.settings.imu import ImuSensorSettings
from ins_sim.settings.shown import exact, listed, shown


@pytest.mark.parametrize('value', ['x' * 3_000_000, ['y'] * 1_000_000, 10 ** 5000,
                                   {'a': 'z' * 10 ** 6}],
                         ids=['text', 'list', 'digits', 'mapping'])
def test_a_value_of_megabytes_is_cut(value):
    """A long value is truncated to about a hundred characters, with its length."""
    assert len(shown(value)) < 100
    for name in ('gap_factor', 'initial.velocity_m_s', 'on_gap'):
        with pytest.raises(ValueError) as caught:
            build(NavigateSettings, {name: value})
        assert len(str(caught.value)) < 400 and name in str(caught.value)


def test_names_are_counted():
    """A list of a million names is shown as eight names and the number of the others."""
    assert listed(f'c{k}' for k in range(1_000_000)).endswith('c7 and 999992 more')
    assert listed('ab') == 'a, b'


def test_a_value_beside_its_bound_is_told_from_it():
    """2**31 is printed exactly, and not like its bound 2147483647 as '2.14748e+09'."""
    assert exact(2 ** 31) == '2147483648' and exact(0.1) == '0.1' and exact(1e6) == '1e+06'
    assert exact(50000.0) == '50000' and exact(1e300) == '1e+300'
    with pytest.raises(ValueError, match='is 2147483648; expected 0 to 2147483647'):
        build(ImuSensorSettings, {'seed': 2 ** 31})
