"""
Run all benchmarks, by default short ones, and print their results and ratios.

Run: python benchmarks/run.py [--full] [--against CHECKOUT]
"""

import argparse
from pathlib import Path
import subprocess
import sys

HERE = Path(__file__).resolve().parent
# Script, arguments of the short run, arguments of the full one, whether it needs rclpy.
SCRIPTS = (
    ('core_step', [], [], False),
    ('steps', ['60000'], ['360000'], False),
    ('whole_run', ['600'], ['3600'], False),
    ('memory', [], ['--full'], False),
    ('run_files', [], [], False),
    ('pyins_peer', ['600'], ['3600'], False),
    ('parts', ['600'], ['3600'], False),
    ('tuned_gyro', [], [], False),
    ('filters', [], [], False),
    ('ensemble', [], [], False),
    ('budget', [], [], False),
    ('delay_study', ['600'], ['3600'], False),
    ('bags', ['20000'], ['100000'], False),
    ('velocity_meter', ['400', '20'], ['2000', '100'], False),
    ('live_chain', ['--quick'], [], True),
    ('one_process', ['--quick'], [], True),
    ('live_recorder', ['10'], ['600'], True),
    ('live_aided', ['20'], ['600'], True))


def has_rclpy():
    """Return whether nodes can be started here."""
    return subprocess.run([sys.executable, '-c', 'import rclpy'], capture_output=True,
                          check=False).returncode == 0


def main():
    """Run all scripts that can run here; return 1 if one of them failed."""
    parser = argparse.ArgumentParser(description=__doc__.strip().splitlines()[0])
    parser.add_argument('--full', action='store_true', help='as long as the figures of the docs')
    parser.add_argument('--against', metavar='CHECKOUT', help='compare with another checkout too')
    arguments = parser.parse_args()
    ros, failed = has_rclpy(), []
    commands = [(name, full if arguments.full else short) for name, short, full, needs in SCRIPTS
                if ros or not needs]
    if arguments.against:
        length = '3600' if arguments.full else '600'
        commands.append(('paired', [arguments.against, '--seconds', length]))
    for name, words in commands:
        print(f'\n== {name} {" ".join(words)}', flush=True)
        if subprocess.run([sys.executable, HERE / f'{name}.py', *words], check=False).returncode:
            failed.append(name)
    if not ros:
        print('\nno rclpy: the live benchmarks were left out')
    if failed:
        print(f'\nfailed: {", ".join(failed)}')
    return 1 if failed else 0


if __name__ == '__main__':
    sys.exit(main())
