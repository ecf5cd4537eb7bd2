"""The example of docs/how_to/add_filter.md is a complete filter, which corrects the solution."""

from pathlib import Path
import re

from ins_sim.settings.aided_navigator import FILTERS
import pytest

PAGE = Path(__file__).resolve().parents[2] / 'docs' / 'how_to' / 'add_filter.md'


@pytest.fixture
def example(tmp_path, monkeypatch):
    """Save and register the filter as the page describes; return the code that uses it."""
    code, register, fly = re.findall(r'```python\n(.*?)```', PAGE.read_text(encoding='utf-8'),
                                     re.DOTALL)
    assert len(code.splitlines()) <= 20
    (tmp_path / 'mean_velocity.py').write_text(code, encoding='utf-8')
    monkeypatch.syspath_prepend(tmp_path)
    # Restores the table after the test.
    monkeypatch.setitem(FILTERS, 'mean_velocity', None)
    exec(compile(register, str(PAGE), 'exec'), {})
    return fly


def test_the_filter_of_the_page_corrects_the_solution(example):
    """
    After 60 s the filter of the page has less than a third of the error of the free solution.

    The free one drifts for 60 s with the initial velocity error v = 2.3 m/s. Windows of 2 s with
    gain 0.4 leave 2 / 0.4 = 5 s of it, a twelfth or 11 m; fixes with 0.6 m/s of noise add a random
    walk of 7 m on each axis (one standard deviation), hence a third.
    """
    names = {}
    exec(compile(example, str(PAGE), 'exec'), names)
    errors = names['errors']
    print(f"free {errors['free']:.1f} m, mean_velocity {errors['mean_velocity']:.1f} m")
    assert errors['mean_velocity'] < errors['free'] / 3.0
