"""What the launch files start: processes, precedence and overrides, as rcl reads them."""

import pytest

from ins_sim import graph, resources
from ins_sim.launching import arguments, plan
from ins_sim.messages import topics
from ins_sim.ros_parameters import Parameters


@pytest.fixture(autouse=True)
def transforms(monkeypatch):
    """Make tf2_msgs available, as on a machine with ROS."""
    found = {'tf2_msgs': object()}
    monkeypatch.setattr(plan, 'find_spec', found.get)
    return found


def simulation(namespace='', **given):
    """Return the Plan of the launch file simulation."""
    texts = {one.name: one.default for one in arguments.SIMULATION}
    assert set(given) <= set(texts)
    return plan.simulation({**texts, **given}, namespace)


def replay(**given):
    """Return the Plan of the launch file replay, and the played topics."""
    texts = {one.name: one.default for one in arguments.REPLAY}
    return plan.replay({**texts, 'bag': 'old', **given})[:2]


def parameters(made, node):
    """Return {parameter: value} of a node of a Plan, by the rules of rcl."""
    read = Parameters()
    for name, value in made.defaults.items():
        read.add_value('/**', name, value, '-p')
    for path in made.files:
        read.add_file(open(path, 'rb').read(), path)
    if made.overrides_text:
        read.add_file(made.overrides_text.encode(), 'overrides')
    found = read.of(f'/{made.namespace}/{node}' if made.namespace else f'/{node}')
    return {name: one.value for name, one in found.items()}


def named(made):
    """Return the names of the processes of a Plan."""
    return [process.name for process in made.processes]


@pytest.mark.parametrize('namespace', ['', 'left', 'fleet/left'])
def test_the_launch_line(namespace):
    """
    Launch arguments reach all nodes that have the parameters they set.

    They are motion, instrument, rate, prefix, recorder, clock and aiding.
    """
    made = simulation(namespace, motion='racetrack', imu='imu_tactical_mems', rate_hz='200.0',
                      use_sim_time='true', prefix='uav1', record='DIR', aided='true')
    assert set(named(made)) == {process.name for process in (
        *graph.PROCESSES, *graph.AIDING, graph.RECORDER)}
    for process in (*graph.PROCESSES, *graph.AIDING):
        own = parameters(made, process.name)
        assert own['rate_hz'] == 200.0 and own['motion.kind'] == 'racetrack'
        assert own['frames.prefix'] == 'uav1' and own['tf.source'] == 'aided'
        assert own['use_sim_time'] is True
        assert own['gyro.errors.angle_random_walk_deg_sqrt_h'] == [0.04] * 3
        assert own['imu_model.gyro_bias_sigma_deg_h'] > 7.0
        assert 'gyro.delay_us.x' not in own
    generator = parameters(made, 'motion_generator')
    assert generator['publish_clock'] is True and generator['pacing.lock_step'] is True
    assert generator['pacing.required'] == ['strapdown', 'recorder', *(
        process.name for process in graph.AIDING)]
    recorder = parameters(made, 'recorder')
    assert recorder['storage.path'] == 'DIR'
    assert recorder['record.topics'] == [topic.name for topic in (
        topics.RUN, *topics.DATA, *topics.AIDING, topics.TF, topics.TF_STATIC)]
    assert not made.said


def test_no_arguments():
    """Without arguments only tf.source differs from the defaults of the nodes."""
    made = simulation()
    assert named(made) == [process.name for process in graph.PROCESSES]
    assert not made.files and not made.overrides_text
    assert parameters(made, 'strapdown') == {'tf.source': 'ins'}
    assert made.default_words == ['-p', 'tf.source:=ins']


def test_a_users_wildcard_counts(tmp_path):
    """The user's /** overrides presets, with integers or floats; launch arguments override it."""
    own = tmp_path / 'own.yaml'
    own.write_text('/**:\n  ros__parameters:\n    rate_hz: 50\n    tf: {source: none}\n'
                   '    gyro: {errors: {angle_random_walk_deg_sqrt_h: [0.5, 0.5, 0.5]}}\n')
    made = simulation(motion='motion_2', imu='imu_tactical_mems', params_file=str(own))
    for node in ('imu_sensor', 'strapdown'):
        found = parameters(made, node)
        assert found['rate_hz'] == 50 and found['tf.source'] == 'none'
        assert found['gyro.errors.angle_random_walk_deg_sqrt_h'] == [0.5] * 3
        assert found['gyro.errors.turn_on_bias_sigma_deg_h'] == [7.0] * 3
    made = simulation(imu='imu_tactical_mems', params_file=str(own), rate_hz='200', tf='truth')
    assert parameters(made, 'imu_sensor')['rate_hz'] == 200.0
    assert parameters(made, 'imu_sensor')['tf.source'] == 'truth'


@pytest.mark.parametrize('section', ['/**', '/**/imu_sensor', 'imu_sensor', '/*'])
def test_launch_arguments_win_over_every_section(section, tmp_path):
    """Launch arguments override sections of single nodes too."""
    own = tmp_path / 'own.yaml'
    own.write_text(f'{section}: {{ros__parameters: {{rate_hz: 50.0}}}}')
    made = simulation(params_file=str(own), rate_hz='200.0')
    assert parameters(made, 'imu_sensor')['rate_hz'] == 200.0


def test_files_in_their_order(tmp_path):
    """A later parameter file overrides an earlier one; both override the presets."""
    for name, rate in (('a', 50.0), ('b', 60.0)):
        (tmp_path / f'{name}.yaml').write_text(
            f'/**: {{ros__parameters: {{rate_hz: {rate}, motion.kind: static, seed: 3}}}}')
    paths = [str(tmp_path / name) for name in ('a.yaml', 'b.yaml')]
    for text, rate in ((','.join(paths), 60.0), (' '.join(reversed(paths)), 50.0)):
        found = parameters(simulation(motion='racetrack', params_file=text), 'imu_sensor')
        assert found['rate_hz'] == rate and found['motion.kind'] == 'static'


def test_one_process():
    """With one_process the executable simulation replaces the nodes, with their parameters."""
    made = simulation('left', one_process='true', aided='true', record='bag', rate_hz='50')
    assert named(made) == ['recorder', 'simulation'] and made.named == {'recorder'}
    assert parameters(made, 'simulation')['aided'] is True
    for process in (*graph.PROCESSES, *graph.AIDING):
        assert parameters(made, process.name)['rate_hz'] == 50.0
    required = parameters(made, 'motion_generator')['pacing.required']
    assert required == ['strapdown', 'recorder', 'aided_navigator', 'velocity_meter', 'gnss']
    assert parameters(simulation(one_process='true'), 'simulation')['aided'] is False


@pytest.mark.parametrize('lock_step, waits, said', [
    ('', True, False), ('true', True, False), ('false', False, True)])
def test_a_recorder_is_waited_for(lock_step, waits, said):
    """The generator waits for the recorder; with lock_step:=false possible losses are stated."""
    made = simulation(record='bag', lock_step=lock_step)
    assert parameters(made, 'motion_generator')['pacing.lock_step'] is waits
    assert (made.said == (plan.LOSSES,)) is said
    assert 'pacing.lock_step' not in parameters(simulation(), 'motion_generator')


def test_only_what_is_published_is_recorded(transforms):
    """Unpublished topics are not recorded, because lock-step waits for every recorded topic."""
    def recorded(**given):
        return parameters(simulation(record='bag', **given), 'recorder')['record.topics']

    steering = {topic.name for topic in topics.GUIDANCE}
    assert steering <= set(recorded(aided='true', motion='guided_flight'))
    assert not steering & set(recorded(aided='true', motion='racetrack'))
    assert '/tf' in recorded() and '/tf' not in recorded(tf='none')
    transforms.clear()
    assert '/tf' not in recorded() and '/tf' in recorded(tf='ins')


def test_without_tf2_msgs(transforms):
    """Without tf2_msgs the plan has one message; with an explicit tf each node logs its own."""
    transforms.clear()
    made = simulation()
    assert made.said == (plan.NO_TRANSFORMS,) and not made.defaults
    assert parameters(simulation(tf='ins'), 'strapdown')['tf.source'] == 'ins'


@pytest.mark.parametrize('given, says', [
    ({'prefix': '/uav1'}, "frames.prefix is '/uav1'; expected no slash at its ends"),
    ({'prefix': 'uav1/'}, "frames.prefix is 'uav1/'; expected no slash at its ends"),
    ({'prefix': 'uav 1'}, "frames.prefix is 'uav 1'; expected a name without spaces"),
    ({'rate_hz': '-1'}, 'rate_hz is -1 Hz; expected 0.01 to 20000 Hz'),
    ({'real_time_factor': '-1'}, 'pacing.real_time_factor is -1; expected 0 to 1e+06'),
    ({'tf': 'aided'}, 'tf is aided; expected aided:=true with it'),
    ({'motion': 'moton_1'}, "motion is 'moton_1'; expected a path or one of aggressive, ")])
def test_what_a_node_would_refuse_is_refused_before(given, says):
    """Values that a node would refuse are refused before anything starts."""
    with pytest.raises(ValueError) as refused:
        simulation(**given)
    assert str(refused.value).startswith(says)


def test_a_file_that_is_none(tmp_path):
    """An invalid parameter file is refused with the message of the offline commands."""
    path = tmp_path / 'a.yaml'
    path.write_text('/**: {ros__parameters: {')
    with pytest.raises(ValueError, match='a.yaml is not YAML: line 2'):
        simulation(params_file=str(path))


def test_replay():
    """replay has the nodes downstream of the source; an IMU only for a played truth."""
    for source, names in (('imu', ['strapdown']), ('truth', ['strapdown', 'imu_sensor'])):
        made, played = replay(source=source, rate_hz='50', prefix='uav1')
        assert named(made) == names and played is graph.REPLAYS[source]
        for name in names:
            assert parameters(made, name) == {'tf.source': 'ins', 'frames.prefix': 'uav1',
                                              'rate_hz': 50.0}
    made, _ = replay(source='truth', imu='imu_tactical_fog', params_file='motion_2')
    assert made.files == tuple(str(resources.config(name))
                               for name in ('imu_tactical_fog', 'motion_2'))
    for given, says in (({'source': 'ins'}, "source is 'ins'; expected one of imu, truth"),
                        ({'imu': 'imu_tactical_fog'}, "imu is 'imu_tactical_fog', but source"),
                        ({'tf': 'truth'}, "tf is 'truth'; expected one of none, ins")):
        with pytest.raises(ValueError, match=says):
            replay(**given)


@pytest.mark.parametrize('given, words', [
    ({}, ['--lock-step', 'strapdown']), ({'lock_step': 'false', 'rate': '2'}, ['--rate', '2.0']),
    ({'loop': 'true', 'use_sim_time': 'true'}, ['--lock-step', 'strapdown', '--loop', '--clock'])])
def test_options_of_the_player(given, words):
    """The options of the player are those of the verb play."""
    texts = {one.name: one.default for one in arguments.REPLAY}
    value = plan.replay({**texts, 'bag': 'old', **given})[2]
    assert plan.play_options(value) == words
