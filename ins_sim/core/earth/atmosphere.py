"""
The standard atmosphere: static pressure as a function of height.

Source: ISO 2533:1975; U.S. Standard Atmosphere 1976, table 4: layers of geopotential height.
"""

from ins_sim.core.numerics.elementary import exp, log

# For each layer: height of its base (m), temperature there (K), temperature gradient (K/m).
LAYERS = ((0.0, 288.15, -0.0065), (11000.0, 216.65, 0.0), (20000.0, 216.65, 0.001),
          (32000.0, 228.65, 0.0028), (47000.0, 270.65, 0.0), (51000.0, 270.65, -0.0028),
          (71000.0, 214.65, -0.002), (84852.0, 186.946, 0.0))
SEA_LEVEL_PA = 101325.0
# g0 M / R, K/m.
LAPSE = 9.80665 * 0.0289644 / 8.31432


def pressure(height):
    """
    Return the static pressure, Pa, at any height, m.

    The height above the ellipsoid is used as geopotential height. They differ by the undulation
    of the geoid and by h^2 / R, 16 m at 10 km. Above the last layer the temperature is constant.
    """
    found = SEA_LEVEL_PA
    for k, (base, temperature, rate) in enumerate(LAYERS):
        top = LAYERS[k + 1][0] if k + 1 < len(LAYERS) else height
        if k and height <= base:
            break
        found = found * _ratio(min(height, top) - base, temperature, rate)
    return found


def pressure_height(static_pa):
    """Return the height, m, at which the static pressure is static_pa > 0, Pa."""
    at_base = SEA_LEVEL_PA
    for k, (base, temperature, rate) in enumerate(LAYERS):
        at_top = 0.0
        if k + 1 < len(LAYERS):
            at_top = at_base * _ratio(LAYERS[k + 1][0] - base, temperature, rate)
        if static_pa > at_top:
            break
        at_base = at_top
    fallen = log(static_pa / at_base)
    if rate == 0.0:
        return base - temperature / LAPSE * fallen
    return base + temperature / rate * (exp(-rate / LAPSE * fallen) - 1.0)


def _ratio(rise, temperature, rate):
    """Return the pressure after a rise (m) in a layer, relative to that at its base."""
    if rate == 0.0:
        return exp(max(-700.0, -LAPSE * rise / temperature))
    return exp(-LAPSE / rate * log((temperature + rate * rise) / temperature))
