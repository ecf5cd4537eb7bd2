"""Make text from files or other processes safe for a terminal or a log."""

import re

# Control characters, which a terminal may interpret; marks that change the direction of a line;
# and surrogates, which occur in file names that are not UTF-8.
_UNSEEN = re.compile(
    '[\x00-\x1f\x7f-\x9f\u200e\u200f\u2028-\u202e\u2066-\u2069\ud800-\udfff]')


def visible(text, keep=''):
    r"""
    Return a text with invisible characters replaced by escapes such as \x1b.

    Characters in keep, such as '\n', are not replaced.
    """
    return _UNSEEN.sub(lambda found: found[0] if found[0] in keep else
                       found[0].encode('unicode_escape').decode('ascii'), text)
