"""Write trajectories as TUM files for evo: time, position, attitude, separated by spaces."""

import numpy as np

from ins_sim.core.numerics.instants import seconds

HEAD = '# stamp [s], position East, North, Up [m], attitude x y z w of base_link'


def write_trajectory(path, frame, history):
    """
    Write positions and attitudes of a PlacedHistory in the axes of a MapFrame.

    Stamps are exact; each other number is written as the shortest text that restores its bits.
    """
    with open(path, 'w', encoding='ascii') as file:
        file.write(f'{HEAD}\n')
        for block in history.blocks():
            position, attitude, _ = frame.pose(block.lat, block.lon, block.height, block.v_n,
                                               block.q_nb)
            rows = np.concatenate([position, attitude], axis=1).tolist()
            for t_ns, row in zip(block.t_ns.tolist(), rows):
                stamp = seconds(t_ns).removesuffix(' s')
                file.write(f'{stamp} {" ".join(map(repr, row))}\n')


def write_trajectories(folder, frame, records):
    """Write <name>.tum into a folder for each of {name: PlacedHistory}."""
    for name, history in records.items():
        write_trajectory(folder / f'{name}.tum', frame, history)
