"""What the verbs share whose work goes in blocks: on which processors, and how they go on."""

from contextlib import contextmanager


def add_arguments(parser):
    """Add --jobs and --scheduler."""
    parser.add_argument('--jobs', type=int, default=0, metavar='N', help='processes (default: '
                        'as many as cores)')
    parser.add_argument('--scheduler', default=None, metavar='ADDRESS', help='of a Dask cluster '
                        'that computes in the place of processes, such as tcp://host:8786')


@contextmanager
def computed(work, blocks, chosen, identity, console, unit):
    """
    Give the iterable of number and arrays of each block, in order, whoever computes it.

    Finished blocks are kept beside the output until the block of the caller has ended well, so
    that the same command goes on where it was interrupted.

    Parameters
    ----------
    work, blocks : as of ``jobs.blocks.run_blocks``
    chosen : the arguments of the verb: output, jobs, scheduler
    identity : dict of what decides the numbers, of ``jobs.fingerprint.fingerprint``
    console : where the progress is shown
    unit : what is counted, such as 'flights'

    """
    from ins_sim.jobs.blocks import run_blocks
    from ins_sim.jobs.executors import open_executor
    from ins_sim.jobs.store import BlockStore
    from ..progress import progress_bars
    with open_executor(chosen.jobs, chosen.scheduler) as executor:
        store = BlockStore(f'{chosen.output}.blocks', identity)
        if store.found:
            console.print(f'{store.folder}: {store.found} of {len(blocks)} {unit} are there '
                          'already')
        try:
            with progress_bars(console, unit) as add_bar:
                show = add_bar('flying', len(blocks) - store.found)
                yield run_blocks(work, blocks, executor, store, show)
        except BaseException:
            if not any(number in store for number in range(len(blocks))):
                store.remove()
            raise
        store.remove()
