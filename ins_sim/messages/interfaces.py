"""
The interface of each node: its topics and services.

The reference pages are made of this table, and a test compares it with the running nodes.
"""

from dataclasses import dataclass
from typing import NamedTuple

from . import topics
from .topic_contents import DIAGNOSTICS

SET_BOOL, TRIGGER = 'std_srvs/srv/SetBool', 'std_srvs/srv/Trigger'
_GUIDED = 'motion.kind is guided'
_LOCK_STEP = 'in lock-step (pacing.lock_step, or pacing.real_time_factor 0)'
_STANDARD = 'the package simulation_interfaces is installed'
_TRUTH = 'initial.source is truth'
_ALONE = 'initial.source is not truth'


# Depths of queues that are not topics.depth, or 1 of a latched topic.
DEPTHS = {topics.ACK: 1000, DIAGNOSTICS: 10, topics.TF: 100}


class Use(NamedTuple):
    """A topic that a node publishes or subscribes to; condition: '' for always."""

    topic: topics.Topic
    condition: str = ''


class Service(NamedTuple):
    """A service of a node: name, type and what it does; condition: '' for always."""

    name: str
    type_name: str
    meaning: str
    condition: str = ''


@dataclass(frozen=True)
class Interface:
    """What a node does, and how other nodes reach it."""

    purpose: str
    publishes: tuple[Use, ...] = ()
    subscribes: tuple[Use, ...] = ()
    services: tuple[Service, ...] = ()


def _uses(*all_topics, condition=''):
    return tuple(Use(topic, condition) for topic in all_topics)


# What every node that follows a stream has in addition to its own topics and services.
_RESET = Service('~/reset', TRIGGER, 'Discard all input received so far and start anew.')
_FOLLOWS = _uses(topics.STATUS, topics.RUN)
_SAYS = _uses(topics.ACK, DIAGNOSTICS)
_PLACES_FIXED = _uses(topics.TF_STATIC, condition='tf.source is not none')

INTERFACES = {
    'motion_generator': Interface(
        'Generates the true motion of the vehicle and publishes it, in real time, scaled time or '
        'lock-step. It is the master of time: its end ends the run.',
        (*_uses(*topics.TRUTH, topics.RUN, topics.STATUS, DIAGNOSTICS),
         Use(topics.CLOCK_TOPIC, 'publish_clock is true'),
         Use(topics.TF, 'tf.source is truth'),
         Use(topics.GUIDANCE_COMMAND, _GUIDED)),
        (Use(topics.ACK, _LOCK_STEP), Use(topics.AIDED_ODOMETRY, f'{_GUIDED}; guidance.topic '
                                          'names another one'),
         Use(topics.TF, 'tf.source is truth, to find a second publisher of its frame')),
        (Service('~/pause', SET_BOOL, 'Pause the run (true) or continue it (false).'),
         Service('~/step', TRIGGER, 'Publish one sample while paused.'),
         Service('~/reset', TRIGGER, 'Return to the first sample.'),
         Service('~/engage', SET_BOOL, 'Engage the autopilot (true) or fly straight (false).',
                 _GUIDED),
         *(Service(f'~/{name}', f'simulation_interfaces/srv/{kind}', meaning, _STANDARD)
           for name, kind, meaning in (
               ('get_simulator_features', 'GetSimulatorFeatures',
                'Return which of these services are supported.'),
               ('get_simulation_state', 'GetSimulationState',
                'Return whether the run is stopped, playing or paused.'),
               ('set_simulation_state', 'SetSimulationState', 'Play, pause, stop or quit.'),
               ('step_simulation', 'StepSimulation',
                'Publish several samples while paused, and answer when they are published.'),
               ('reset_simulation', 'ResetSimulation', 'Return to the first sample.'))))),
    'imu_sensor': Interface(
        'Simulates an IMU: samples the true motion, and adds channel delays, instrument errors '
        'and noise.',
        (*_uses(topics.IMU_RAW), Use(topics.IMU_PARITY, 'gyro.model is dtg'),
         Use(topics.IMU_MAG, 'magnetometer.publish is true'),
         Use(topics.IMU_PRESSURE, 'barometer.publish is true'), *_PLACES_FIXED, *_SAYS),
        (Use(topics.TRUTH_IMU), Use(topics.TRUTH_ODOMETRY, 'magnetometer.publish or '
                                    'barometer.publish is true'), *_FOLLOWS),
        (_RESET, Service('~/fault', SET_BOOL, 'Switch the fault of gyro.dtg.fault on or off.',
                         'gyro.model is dtg'))),
    'strapdown': Interface(
        'Integrates the readings of the IMU to attitude, velocity and position without aiding, '
        'and publishes the errors of this solution. With another initial.source than truth it '
        'navigates a real IMU and needs no simulation.',
        (*_uses(topics.INS_ODOMETRY, topics.INS_FIX), *_uses(*topics.ERRORS, condition=_TRUTH),
         Use(topics.IMU_DATA, 'imu_data is true'), Use(topics.TF, 'tf.source is ins or aided'),
         Use(topics.TF_STATIC, 'tf.source is ins'), *_SAYS),
        (Use(topics.IMU_RAW, 'named by inputs.imu if initial.source is not truth'),
         Use(topics.TRUTH_ODOMETRY, _TRUTH), Use(topics.RUN, _TRUTH),
         Use(topics.GNSS_FIX, f'{_ALONE}; named by inputs.fix'),
         Use(topics.IMU_PRESSURE, f'{_ALONE}; named by inputs.pressure'),
         Use(topics.IMU_MAG, f'{_ALONE}; named by inputs.magnetic_field'),
         Use(topics.TF_STATIC, f'{_ALONE}: the mounting of the IMU'),
         Use(topics.TF, 'tf.source is ins or aided, to find a second publisher of its frame'),
         Use(topics.STATUS)),
        (_RESET, Service('~/align', TRIGGER, 'Align again, as at the start; the vehicle must be '
                         'at rest. Refused if initial.source is truth.'))),
    'velocity_meter': Interface(
        'Simulates a correlation velocity meter: mean forward and lateral velocity over windows, '
        'from the correlation of three antenna signals or from a surrogate model.',
        (*_uses(topics.METER_RECORD, topics.METER_VELOCITY), *_PLACES_FIXED, *_SAYS),
        (Use(topics.TRUTH_ODOMETRY), Use(topics.INS_ODOMETRY, 'attack_angle is ins'), *_FOLLOWS),
        (_RESET,)),
    'gnss': Interface(
        'Simulates a GNSS receiver: position and velocity fixes of the antenna, with outages, '
        'jumps and latency.',
        (*_uses(topics.GNSS_FIX, topics.GNSS_VELOCITY), *_PLACES_FIXED, *_SAYS),
        (Use(topics.TRUTH_ODOMETRY), *_FOLLOWS),
        (_RESET, Service('~/outage', SET_BOOL, 'Force an outage (true) or end it (false).'))),
    'aided_navigator': Interface(
        'Integrates the readings of the IMU and corrects the solution by fixes of the velocity '
        'meter and of GNSS, with a filter that can be chosen.',
        (*_uses(topics.AIDED_ODOMETRY, topics.AIDED_FIX, *topics.AIDED_ERRORS,
                *topics.AIDED_SIGMAS, topics.AIDED_ORTHODROME),
         Use(topics.TF, 'tf.source is aided'), *_SAYS),
        (*_uses(topics.IMU_RAW, topics.TRUTH_ODOMETRY),
         Use(topics.METER_RECORD, 'meter_model.use is true'),
         *_uses(topics.GNSS_FIX, topics.GNSS_VELOCITY, condition='gnss_model.use is true'),
         Use(topics.INS_ODOMETRY, 'tf.source is aided'),
         Use(topics.TF, 'tf.source is aided, to find a second publisher of its frame'),
         *_FOLLOWS),
        (_RESET,)),
    'truth_adapter': Interface(
        'Turns the odometry of another simulator, or of motion capture, into the truth of this '
        'one. It is the master of time in place of motion_generator.',
        (*_uses(*topics.TRUTH, topics.RUN, topics.STATUS),
         Use(topics.TF, 'tf.source is truth'), *_SAYS),
        (Use(topics.OTHER_ODOMETRY), Use(topics.ACK, _LOCK_STEP),
         Use(topics.TF, 'tf.source is truth, to find a second publisher of its frame'),
         *_FOLLOWS),
        (_RESET,)),
    'recorder': Interface(
        'Records topics of any type into a rosbag2 bag. It subscribes to the topics of '
        'record.topics, or to all, with the quality of service that their publishers offer. '
        'ins_sim record starts it.',
        _SAYS),
    'simulation': Interface(
        'Runs motion_generator, imu_sensor and strapdown in one process, and velocity_meter, gnss '
        'and aided_navigator if aided is true. Each keeps its name, topics, services and '
        'parameters.'),
    'player': Interface(
        'Publishes the messages of a rosbag2 bag under their recorded names. It has no '
        'parameters; ins_sim play starts it.',
        (Use(topics.CLOCK_TOPIC, 'with --clock'), *_uses(DIAGNOSTICS)),
        (Use(topics.ACK, 'with --lock-step'),)),
}


def quality(topic):
    """Return reliability, durability and depth of the queue of a topic, in words."""
    if topic.latched:
        return 'reliable, transient local, depth 1'
    return f'reliable, volatile, depth {DEPTHS.get(topic, "topics.depth")}'
