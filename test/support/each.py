"""Check many items in one test, which names every item that fails."""


def each(items, name=str):
    """
    Make one test of a check of one item.

    Hundreds of files, each in a test of its own, take minutes to collect and to hand out. The
    test fails with what the check said about every item that does not pass.

    Parameters
    ----------
    items : iterable
    name : function that returns the name of an item, for the message

    Returns
    -------
    Decorator of a function with one argument, the item.
    """
    items = list(items)
    assert items, 'there is nothing to check'

    def make(check):
        def test():
            wrong = []
            for item in items:
                try:
                    check(item)
                except Exception as error:
                    wrong.append(f'{name(item)}: {type(error).__name__}: {error}')
            assert not wrong, '\n'.join(wrong)
        test.__name__, test.__doc__ = check.__name__, check.__doc__
        return test
    return make
