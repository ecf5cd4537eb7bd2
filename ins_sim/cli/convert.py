"""Verb convert: a recorded flight or IMU between CSV and bag."""

from rich.console import Console

from ins_sim.io.convert import convert
from . import settings as chosen_settings


def run(chosen):
    """Convert and say what was written; return the exit code."""
    settings = chosen_settings.read(chosen).motion_generator
    written = convert(chosen.source, chosen.target, settings, chosen.topic, chosen.storage,
                      chosen.compression, chosen.force)
    Console().print(f'written: {written}', markup=False, highlight=False, soft_wrap=True)
    return 0
