"""``python -m ins_sim`` is the command ``ins_sim``."""

from ins_sim.entry import command

if __name__ == '__main__':
    command()
