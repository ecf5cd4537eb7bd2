"""Shorten values and names so that they fit into a message."""

LONGEST = 60
MOST = 8


def shown(value, longest=LONGEST):
    """Return the repr of a value, truncated after `longest` characters."""
    try:
        text = repr(value if not isinstance(value, str) else value[:longest + 1])
        size = len(value) if isinstance(value, str) else len(text)
    except ValueError:
        # Python refuses to print whole numbers of more than 4300 digits.
        return 'a whole number of thousands of digits'
    if size <= longest or len(text) <= longest:
        return text
    return f'{text[:longest]}... ({size} characters)'


def listed(names, most=MOST):
    """Return the first few names, separated by commas, and the number of the others."""
    names = list(names)
    text = ', '.join(cut(str(name)) for name in names[:most])
    return text if len(names) <= most else f'{text} and {len(names) - most} more'


def cut(text, longest=LONGEST):
    """Return a text, truncated after `longest` characters."""
    return text if len(text) <= longest else f'{text[:longest]}... ({len(text)} characters)'


def exact(number):
    """Return the shortest text that is exactly the number, such as 2147483648 or 0.1."""
    try:
        short = f'{number:g}'
        if float(short) == number:
            return short
        return repr(number).removesuffix('.0')
    except (OverflowError, ValueError):
        return f'a whole number of {number.bit_length()} bits'
