"""Describe in one line, logged at the start, what a node simulates."""

from ins_sim.settings.catalogue import values_of

# Errors that are listed with their values; of other errors only the number is given.
GYRO = (('ARW', 'angle_random_walk_deg_sqrt_h', 'deg/sqrt(h)'),
        ('noise', 'noise_density_rad_s_sqrt_hz', 'rad/s/sqrt(Hz)'),
        ('turn-on bias', 'turn_on_bias_sigma_deg_h', 'deg/h'), ('bias', 'bias_deg_h', 'deg/h'),
        ('bias instability', 'bias_instability_deg_h', 'deg/h'),
        ('scale factor', 'scale_factor_sigma_ppm', 'ppm'))
ACCELEROMETER = (('VRW', 'velocity_random_walk_m_s_sqrt_h', 'm/s/sqrt(h)'),
                 ('noise', 'noise_density_m_s2_sqrt_hz', 'm/s^2/sqrt(Hz)'),
                 ('turn-on bias', 'turn_on_bias_sigma_ug', 'ug'), ('bias', 'bias_ug', 'ug'),
                 ('bias instability', 'bias_instability_ug', 'ug'),
                 ('scale factor', 'scale_factor_sigma_ppm', 'ppm'))


def told(name, settings):
    """Return the line of the node ``name`` with its settings; '' for a node without one."""
    return _LINES[name](settings) if name in _LINES else ''


def clock_needed(generator):
    """Return what other nodes need if the stamps do not follow the wall clock, else ''."""
    pacing = generator.pacing
    if not pacing.waits and pacing.real_time_factor == 1.0:
        return ''
    why = 'lock-step' if pacing.waits else f'a real_time_factor of {pacing.real_time_factor:g}'
    clock = '' if generator.publish_clock else \
        ', which publish_clock: true publishes (in the launch file use_sim_time:=true)'
    return (f'with {why} the stamps do not follow the wall clock: other nodes need use_sim_time: '
            f'true and /clock{clock}')


def _generator(s):
    motion, pacing = s.motion, s.pacing
    kind = f'{motion.kind} of {motion.recording.path}' if motion.kind == 'recording' \
        else motion.kind
    end = f'to {s.start_s + s.duration_s:g} s' if s.duration_s else 'without end'
    pace = ('as fast as the consumers acknowledge' if not pacing.real_time_factor else
            f'{pacing.real_time_factor:g} times real time' if pacing.real_time_factor != 1.0 else
            'in real time')
    return (f'motion {kind}, truth at {s.rate_hz:g} Hz from {s.start_s:g} s {end}, {pace}'
            f'{", in lock-step" if pacing.waits else ""}')


def _imu(s):
    triads = [_triad(triad, getattr(s, triad), listed) for triad, listed in (
        ('gyro', GYRO), ('accelerometer', ACCELEROMETER))]
    parts = [text for text in triads if text]
    if s.gyro.model == 'dtg':
        parts.insert(0, f'two dynamically tuned gyros ({s.gyro.dtg.preset})')
    parts += _sampling(s.sampling)
    return f'IMU at {s.rate_hz:g} Hz, {s.output}: {"; ".join(parts) or "ideal, no delays"}'


def _triad(name, triad, listed):
    given = _not_default(triad.errors)
    parts = [f'{label} {_axes(given.pop(key))} {unit}' for label, key, unit in listed
             if key in given]
    if given:
        parts.append(f'{len(given)} more')
    delays = (triad.delay_us.x, triad.delay_us.y, triad.delay_us.z)
    if any(delays):
        parts.append(f'delays {_axes(delays)} us')
    return f'{name} {", ".join(parts)}' if parts else ''


def _sampling(sampling):
    return [f'{key.replace("_", " ")} {value:g}' if isinstance(value, float) else
            f'{key.replace("_", " ")} {value}' for key, value in _not_default(sampling).items()]


def _not_default(settings):
    """Return {name: value} of the settings in a group that differ from their defaults."""
    default = values_of(type(settings)())
    return {key: value for key, value in values_of(settings).items() if value != default[key]}


def _strapdown(s):
    start, rate = '', f'an IMU at {s.rate_hz:g} Hz'
    if s.initial.source != 'truth':
        # Without truth any sampling rate of the IMU is accepted.
        start, rate = f' without truth, start from {s.initial.source}', 'any IMU'
    return (f'strapdown for {rate}, {s.input}{start}; vertical channel {s.vertical.channel}, '
            f'attitude by {s.orientation.replace("_", " ")}')


def _meter(s):
    return (f'velocity meter, mode {s.mode}, windows of {s.window.cycles} cycles at '
            f'{s.rate_hz:g} Hz')


def _gnss(s):
    outages = f', outages: {len(s.outages.start_s)}' if s.outages.start_s else ''
    return (f'GNSS at {s.gnss.rate_hz:g} Hz, noise {_axes(s.errors.position_noise_m)} m and '
            f'{_axes(s.errors.velocity_noise_m_s)} m/s (east, north, up){outages}')


def _navigator(s):
    aids = [name for name, used in (('the velocity meter', s.meter_model.use),
                                    ('GNSS', s.gnss_model.use)) if used]
    left = '' if s.gnss_model.use else ' (gnss_model.use: true lets GNSS aid too)'
    return (f'filter {s.filter} for an IMU at {s.rate_hz:g} Hz, aided by '
            f'{" and ".join(aids) or "nothing"}{left}')


def _adapter(s):
    return (f'truth for an IMU at {s.rate_hz:g} Hz from the Odometry of another simulator, twist '
            f'{s.twist}, stamps {s.stamps}')


def _axes(values):
    """Return the numbers of three axes as text, a single one if they are equal."""
    values = values if isinstance(values, tuple) else (values,)
    return f'{values[0]:g}' if len(set(values)) == 1 else \
        f'[{", ".join(f"{value:g}" for value in values)}]'


_LINES = {'motion_generator': _generator, 'imu_sensor': _imu, 'strapdown': _strapdown,
          'velocity_meter': _meter, 'gnss': _gnss, 'aided_navigator': _navigator,
          'truth_adapter': _adapter}
