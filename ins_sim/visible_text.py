"""Texts of files and of strangers, fit for a terminal or a log."""

import re

# control characters, some of which a terminal obeys; marks that turn the direction of a line; and
# halves of characters, which stand in names of files that are no UTF-8
_UNSEEN = re.compile(
    '[\x00-\x1f\x7f-\x9f\u200e\u200f\u2028-\u202e\u2066-\u2069\ud800-\udfff]')


def visible(text, keep=''):
    r"""
    Return a text with what cannot be seen in it as escapes such as \x1b.

    keep: characters that stay, such as '\n'.
    """
    return _UNSEEN.sub(lambda found: found[0] if found[0] in keep else
                       found[0].encode('unicode_escape').decode('ascii'), text)
