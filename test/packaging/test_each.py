"""A test made by ``each`` names every item that fails its check."""

import pytest
from support.each import each


def is_even(number):
    """Accept an even number."""
    assert number % 2 == 0, 'odd'
    return 8 // number


def test_every_failure_is_named():
    """The message has a line for each item that fails, whatever the check raises."""
    with pytest.raises(AssertionError) as caught:
        each([1, 2, 3, 0, 4], lambda number: f'item {number}')(is_even)()
    assert [line for line in str(caught.value).splitlines() if line.startswith('item')] == [
        'item 1: AssertionError: odd', 'item 3: AssertionError: odd',
        'item 0: ZeroDivisionError: integer division or modulo by zero']


def test_items_that_pass():
    """The test passes if all items do, and is called as the check."""
    test = each(iter([2, 4]))(is_even)
    test()
    assert (test.__name__, test.__doc__) == ('is_even', 'Accept an even number.')


def test_nothing_to_check():
    """A list without items is an error, because the test could not fail."""
    with pytest.raises(AssertionError, match='nothing to check'):
        each([])
