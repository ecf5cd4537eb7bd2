"""
The correlation velocity meter: signals of three antennas, correlation functions and their fits.

Start with ``meter``. ``pulses`` simulates the signals, ``surrogate`` replaces them by the errors
of the window mean, and ``reading`` turns correlation functions into a velocity. Source: Ivanov,
Vestnik Koncerna PVO Almaz-Antey 2, 2015; see docs/theory/velocity_meter.md.
"""
