"""Run the command ``ins_sim`` with ``python -m ins_sim``."""

from ins_sim.entry import command

if __name__ == '__main__':
    command()
