"""Page of the exit codes."""

from ins_sim import entry

from .markdown import page, table, text

INTRODUCTION = '''\
The verbs `record` and `play` are nodes and have the exit codes of nodes. `ros2 launch` ends with a
code other than 0 if a node does. The page of each [node](nodes.md) lists its own codes.
'''


def pages():
    """Return {path: Markdown}."""
    lines = []
    for title, codes in (('The command ins_sim', entry.COMMAND_CODES),
                         ('Nodes', entry.NODE_CODES)):
        lines += [f'## {text(title)}', '', *table(('code', 'meaning'), [
            (str(code), text(meaning)) for code, meaning in codes.items()])]
    return {'exit_codes.md': page('Exit codes', INTRODUCTION, *lines)}
