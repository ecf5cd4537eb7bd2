"""Warnings for the user: sentences of ours, and no words of a library."""

import warnings


def tell_warnings(tell):
    """
    Let each warning that is meant for the user be told; others are left out.

    tell: function of a sentence.  Sentences of ours are given by ``warnings.warn`` as UserWarning;
    RuntimeWarning ("invalid value encountered ...") and what libraries announce for their next
    versions say nothing to a user: what a value that is not finite leads to is judged where it
    matters.
    """
    def show(sentence, category, *_):
        if issubclass(category, UserWarning):
            tell(str(sentence))

    warnings.showwarning = show
