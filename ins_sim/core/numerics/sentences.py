"""Warnings for the user: only those of this package, not those of libraries."""

import warnings


def tell_warnings(tell):
    """
    Pass each warning that is meant for the user to a function; suppress all others.

    Warnings of this package are raised by ``warnings.warn`` as UserWarning. A RuntimeWarning
    ("invalid value encountered ...") or an announcement of a library is of no use to a user;
    values that are not finite are handled where they matter.

    Parameters
    ----------
    tell : function of a sentence
    """
    def show(sentence, category, *_):
        if issubclass(category, UserWarning):
            tell(str(sentence))

    warnings.showwarning = show
