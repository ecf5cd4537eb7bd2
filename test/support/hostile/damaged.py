"""Bags to be damaged by tests, and a check of the error message for a damaged bag."""

from ins_sim.bags.bag_reader import open_bag
from ins_sim.bags.bag_writer import BagWriter
from ins_sim.cli.main import main
from ins_sim.messages import topics
from ins_sim.messages.cdr import Writer
import numpy as np
import pytest

N = 20_000
STAMPS = np.arange(N) * 10**7


def write(path, storage='mcap', compression='none', **options):
    """Write N readings of an IMU and a few acknowledgements."""
    imu, ack = topics.IMU_RAW.writer(), Writer(topics.HEADER, 'recorder')
    with BagWriter(path, storage, compression, **options) as bag:
        bag.add_topic('imu/data_raw', topics.IMU)
        bag.add_topic('sim/ack', topics.HEADER)
        for first in range(0, N, 5000):
            stamps = STAMPS[first:first + 5000]
            bag.write_blocks({
                'imu/data_raw': (stamps, imu.block(stamps, np.ones((len(stamps), 6)))),
                'sim/ack': (stamps[::10], ack.block(stamps[::10]))})
    return path


def refused(path, sentence, capsys, read=False):
    """Check that info, or reading, refuses a bag with this message and exit code 2."""
    if not read:
        assert main(['info', str(path)]) == 2
        said = capsys.readouterr().err
        assert said.count('\n') == 1 and sentence in said, said
        return
    for use in (lambda bag: bag.arrays('imu/data_raw'), lambda bag: list(bag.messages())):
        with pytest.raises(ValueError, match=sentence) as caught:
            with open_bag(path) as bag:
                use(bag)
        assert '\n' not in str(caught.value)
