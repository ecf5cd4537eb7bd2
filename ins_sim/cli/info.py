"""Verb info: show the content of a bag."""

from pathlib import Path

from ins_sim.visible_text import visible

HELP = 'show the content of a bag'
DESCRIPTION = 'Show storage, topics, counts, rates and times of a bag, and whether it is complete.'
SECOND_NS = 1_000_000_000


def add_arguments(parser):
    """Add the arguments of the verb to its parser."""
    parser.add_argument('bag', metavar='BAG', help='folder of the bag, or one of its files')


def run(chosen):
    """Show a bag; return the exit code."""
    from ins_sim.bags.bag_reader import open_bag
    from ins_sim.report.console import PlainConsole
    console = PlainConsole()
    with open_bag(chosen.bag) as bag:
        spans = bag.spans()
        counted = [span for span in spans.values() if span.count]
        # Most messages of a database that was not closed are in the write-ahead log next to it.
        logs = (file.with_name(file.name + '-wal') for file in bag.files)
        size = sum(file.stat().st_size for file in (*bag.files, *filter(Path.exists, logs)))
        rows = [
            ('bag', str(bag.path)),
            ('state', f'cut: {bag.cut}' if bag.cut else 'whole'),
            ('storage', f'{bag.storage}, chunks compressed by {", ".join(bag.compression)}'
             if bag.compression != ['none'] else f'{bag.storage}, not compressed'),
            ('files', ', '.join(file.name for file in bag.files)),
            ('size', f'{size / 1e6:.3f} MB'),
            ('messages', str(sum(span.count for span in counted))),
        ]
        if counted:
            first = min(span.first_ns for span in counted)
            last = max(span.last_ns for span in counted)
            rows += [('start', f'{_seconds(first)} s'), ('end', f'{_seconds(last)} s'),
                     ('duration', f'{_seconds(last - first)} s')]
        for name, value in rows:
            console.print(f'{name:9} {visible(value)}')
        _show_topics(bag, spans, console)
    return 0


def _show_topics(bag, spans, console):
    lines = [('topic', 'type', 'messages', 'rate, Hz')]
    for name, channel in bag.topics.items():
        kind = channel.type_name
        if channel.encoding != 'cdr':
            kind += f' ({channel.encoding})'
        lines.append((visible(name), visible(kind), str(spans[name].count), _rate(spans[name])))
    widths = [max(map(len, column)) for column in zip(*lines)]
    for name, kind, count, rate in lines:
        console.print(f'{name:{widths[0]}}  {kind:{widths[1]}}  {count:>{widths[2]}}  '
                      f'{rate:>{widths[3]}}')


def _seconds(t_ns):
    whole, rest = divmod(t_ns, SECOND_NS)
    return f'{whole}.{rest:09d}'


def _rate(span):
    """Return the mean rate between the first and the last message, or a dash."""
    if span.count < 2 or span.last_ns == span.first_ns:
        return '-'
    return f'{(span.count - 1) * SECOND_NS / (span.last_ns - span.first_ns):.6g}'
