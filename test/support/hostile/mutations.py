"""Mutations of bytes and of texts: each function receives a random.Random and the data."""

import re

_NUMBER = re.compile(rb'-?\d+(?:\.\d*)?(?:e[-+]?\d+)?')
_VALUES = [b'nan', b'inf', b'-inf', b'1e300', b'-1e300', b'1e-320', b'9' * 400, b'-' + b'9' * 400,
           b'', b' ', b'0', b'-0', b'1', b'-1', b'1e18', b'9223372036854775807', b'1e9', b'1e6',
           b'9300000000', b'2147483648', b'0x10', b'1_0', b'true', b'"', b'x', b'[', b'{', b'~',
           b'&a [*a]', b'2020-01-01', b'1:30', b'\xff\xfe', b'\0', b'\xf0\x9f\x98\x80']


def flip_bytes(rng, data):
    """Return the bytes with a few of them replaced."""
    data = bytearray(data)
    for _ in range(rng.choice((1, 1, 2, 8))):
        if data:
            data[rng.randrange(len(data))] = rng.choice((0, 255, 10, 44, rng.randrange(256)))
    return bytes(data)


def _cut(rng, data):
    return data[:rng.randrange(len(data) + 1)]


def _insert(rng, data):
    place = rng.randrange(len(data) + 1)
    return data[:place] + rng.randbytes(rng.choice((1, 3, 40))) + data[place:]


def _remove(rng, data):
    place = rng.randrange(len(data) + 1)
    return data[:place] + data[place + rng.choice((1, 4, 100)):]


def _repeat(rng, data):
    place = rng.randrange(len(data) + 1)
    part = data[place:place + rng.choice((1, 8, 300))]
    return data[:place] + part * rng.choice((2, 3, 20)) + data[place:]


def _value(rng, data):
    numbers = list(_NUMBER.finditer(data))
    if not numbers:
        return data
    for found in sorted(rng.sample(numbers, min(len(numbers), rng.choice((1, 1, 3)))),
                        key=lambda match: -match.start()):
        data = data[:found.start()] + rng.choice(_VALUES) + data[found.end():]
    return data


def _line(rng, data):
    lines = data.split(b'\n')
    k = rng.randrange(len(lines))
    how = rng.randrange(6)
    if how == 0:
        del lines[k]
    elif how == 1:
        lines.insert(k, lines[rng.randrange(len(lines))])
    elif how == 2:
        lines[k] = b' ' * rng.choice((1, 2, 300)) + lines[k]
    elif how == 3:
        lines.insert(k, rng.choice((b'# comment', b'% x', b'', b'"', b'\t', b'-' * 80, b'---')))
    elif how == 4:
        lines[k] = lines[k] * rng.choice((2, 50))
    else:
        lines[k:k + 10] = lines[k:k + 10][::-1]
    return b'\n'.join(lines)


def _field(rng, data):
    lines = data.split(b'\n')
    k = rng.randrange(len(lines))
    mark = rng.choice((b',', b': '))
    fields = lines[k].split(mark)
    j = rng.randrange(len(fields))
    how = rng.randrange(4)
    if how == 0:
        del fields[j]
    elif how == 1:
        fields.insert(j, fields[rng.randrange(len(fields))])
    elif how == 2:
        fields[j] = rng.choice(_VALUES)
    else:
        fields[j] = fields[j] * rng.choice((2, 1000))
    lines[k] = mark.join(fields)
    return b'\n'.join(lines)


def _header(rng, data):
    head, _, rest = data.partition(b'\n')
    how = rng.randrange(5)
    if how == 0:
        return rest
    if how == 1:
        return head.replace(b',', rng.choice((b';', b'\t', b' ', b'"'))) + b'\n' + rest
    if how == 2:
        return rng.choice((b'#', b'%', b'\xef\xbb\xbf', b'"')) + head + b'\n' + rest
    if how == 3:
        return _field(rng, head) + b'\n' + rest
    return data.replace(b',', rng.choice((b';', b'\t', b', ')))


BYTES = (flip_bytes, _cut, _insert, _remove, _repeat)
TEXT = (_value, _value, _line, _field, _header)
