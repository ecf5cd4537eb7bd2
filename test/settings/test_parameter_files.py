"""Parameters and parameter files: every shipped file loads and runs, errors are named."""

from dataclasses import replace
import runpy
import warnings

from hypothesis import given, strategies as st
import pytest
import yaml

from ins_sim import parameter_files, resources
from ins_sim.settings.catalogue import build, flatten, values_of
from ins_sim.settings.by_node import ALL_NAMES
from ins_sim.settings.by_node import NODES
from support.studies import run_offline
from support.places import ROOT

# those of other commands are in test_tuned_gyro, studies/delays and test_navigate_command
CONFIG = sorted(p.stem for p in (ROOT / 'config').glob('*.yaml')
                if p.stem != 'navigate' and '_study_' not in p.stem)
NUMBERS = [(node, name) for node, cls in NODES.items() for name, f in flatten(cls).items()
           if f.type is float]


def test_default_yaml_is_the_catalogue():
    """config/default.yaml is what tools/make_config.py writes, and names every key."""
    documents = runpy.run_path(str(ROOT / 'tools' / 'make_config.py'))['documents']()
    for name, text in documents.items():
        assert (ROOT / 'config' / name).read_text() == text
    made = documents['default.yaml']
    settings = parameter_files.read([resources.config('default')])
    for node, cls in NODES.items():
        assert getattr(settings, node) == cls()
        for name in flatten(cls):
            assert f' {name.rsplit(".", 1)[-1]}:' in made


@pytest.mark.parametrize('name', [name for name in CONFIG if name != 'default'])
def test_an_overlay_wins_over_the_default(name):
    """For ROS a key of a node in default.yaml wins over the same key in /** of a later file."""
    default, overlay = (yaml.safe_load(resources.config(n).read_text()) for n in ('default', name))

    def names(section, prefix=''):
        for key, value in section.items():
            yield from names(value, f'{prefix}{key}.') if isinstance(value, dict) else (
                prefix + key,)
    of_nodes = {key for node, section in default.items() if node != '/**'
                for key in names(section['ros__parameters'])}
    shared = overlay.get('/**', {'ros__parameters': {}})['ros__parameters']
    assert not set(names(shared)) & of_nodes


@pytest.mark.parametrize('name', [name for name in CONFIG if name != 'real_imu'])
def test_every_shipped_file_runs(name, shared_flight):
    """Each overlay over the default runs for two seconds offline."""
    assignments = ['motion_generator:duration_s:=2.0']
    if name == 'recorded_flight':
        assignments.append(f'motion_generator:motion.recording.path:="{shared_flight}"')
    settings = parameter_files.read([resources.config('default'), resources.config(name)],
                                    assignments)
    assert len(run_offline(settings).errors) == 201
    alone = parameter_files.read([resources.config(name)], assignments)
    assert alone == settings


def test_the_file_of_a_real_imu_is_none_of_a_simulation():
    """Offline runs refuse real_imu.yaml, whose strapdown aligns itself (see test_real_imu)."""
    with pytest.raises(ValueError, match='initial.source is alignment; expected truth'):
        parameter_files.read([resources.config('real_imu')])


@pytest.fixture
def shared_flight(request):
    """Return the recorded flight where the overlay needs it."""
    if request.node.callspec.params['name'] != 'recorded_flight':
        return None
    return request.getfixturevalue('shared_data') / 'flights' / 'cruise_gv_acclip_rf01.csv.gz'


def test_dump_and_read_are_inverse(tmp_path):
    """The parameters written with a run reproduce its settings."""
    settings = parameter_files.read([resources.config('aggressive')], ['rate_hz:=37.5'])
    path = tmp_path / 'p.yaml'
    path.write_text(parameter_files.dump(settings))
    assert parameter_files.read([path]) == settings
    for node in NODES:
        one = getattr(settings, node)
        assert build(type(one), values_of(one)) == one


BAD_ASSIGNMENTS = [
    ('gyro.delay_us.w:=1', "unknown parameter 'gyro.delay_us.w'; the nearest known one is "
                           "'gyro.delay_us."),
    ('gyro.dely_us.x:=1', "the nearest known one is 'gyro.delay_us.x'"),
    ('rate_hz:=-100.0', 'motion_generator: rate_hz is -100 Hz; expected 0.01 to 20000 Hz'),
    ('gyro.delay_us.x:=.nan', 'imu_sensor: gyro.delay_us.x is nan; expected a finite number'),
    ('datum.latitude_deg:=91', 'datum.latitude_deg is 91 deg; expected -89.9 to 89.9 deg'),
    ('gyro.delay_us.x:=2e6', 'gyro.delay_us.x is 2e+06 us; expected -1e+06 to 1e+06 us'),
    ('rate_hz:=fast', "rate_hz is 'fast'; expected a number"),
    ('rate_hz:=true', 'rate_hz is True; expected a number'),
    ('output_every:=1.5', 'output_every is 1.5; expected a whole number'),
    ('earth.rotation:=1', 'earth.rotation is 1; expected true or false'),
    ('motion.kind:=rockng', "motion.kind is 'rockng'; expected one of static, "),
    ('initial.position_error_m:=[1.0, 2.0]', 'has 2 entries; expected 3'),
    ('initial.position_error_m:=3.0', 'expected a list'),
    ('pacing.window:=2001', 'pacing.window is 2001 steps; expected 1 to 2000 steps'),
    ('topics.depth:=100', 'pacing.window is 200; expected at most topics.depth, 100'),
    ('motion.kind:=recording', 'motion.recording.path is empty'),
    ('rate_hz=5', "-p 'rate_hz=5' has no \":=\"; expected NAME:=VALUE"),
    ('rate_hz:=[', '-p rate_hz:=[ is not YAML: line '),
    ('rate_hz:=', '-p rate_hz:= has no value'), ('rate_hz:={a: 1}', 'is neither a single value'),
    ('rate_hz:=*a', 'is neither a single value nor a list'),
    ('rate_hz:=' + '9' * 400, "'999"), ('rate_hz:=1:30', "rate_hz is '1:30'; expected a number"),
]


@pytest.mark.parametrize('assignment, sentence', BAD_ASSIGNMENTS)
def test_bad_assignments(assignment, sentence):
    """A bad assignment is refused with a sentence that names key, value and expectation."""
    with pytest.raises(ValueError) as error:
        parameter_files.read([], [assignment])
    assert sentence in str(error.value)
    assert '\n' not in str(error.value)


BAD_FILES = [
    (b'', 'holds no parameters'), (b'[]', 'has a list as a key at line 1; expected a name'),
    (b'/**: {ros__parameters: {a: [', 'is not YAML: line '),
    (b'strapdwn:\n  ros__parameters: {rate_hz: 1.0}', "the nearest known one is 'strapdown'"),
    (b'strapdown:\n  rate_hz: 1.0', 'has \'1.0\' before "ros__parameters" at line 2; expected '
     'sections such as "/**: ros__parameters: ..."'),
    (b'strapdown:\n  ros__parameters: {rate_hz: *x}', 'has an alias at line 2; ROS allows none'),
    (b'/**:\n  ros__parameters: {rate_hz: [1.0, 2]}', "has '2' in a list of numbers with a point "
     "at line 2, 'rate_hz'; ROS expects values of one type, such as [1.0, 0.0, 0.0]"),
    (b'/**:\n  ros__parameters: {rate_hz: }', 'has no value at line 2; expected one'),
    (b'/**: {ros__parameters: {a: ' + b'[' * 100, 'is nested deeper than 64 at line 1'),
    (b'gnss:\n  ros__parameters: {seed: -1}', 'bad.yaml: gnss: seed is -1; expected 0 to'),
    (b'/**/gnss:\n  ros__parameters: {sed: 1}', "bad.yaml: unknown parameter 'sed'; the nearest "
     "known one is 'seed'"),
    (b'/a/gnss: {ros__parameters: {seed: 1}}\n/b/gnss: {ros__parameters: {seed: 2}}',
     'the sections belong to 2 namespaces, /a, /b; expected one vehicle'),
    (b'strapdown:\n  ros__parameters: {gyro: {delay_us: {x: 1.0}}}',
     "unknown parameter 'gyro.delay_us.x'"),
    (b'strapdown:\n  ros__parameters: {rate_hz: .inf}', 'rate_hz is inf; expected a finite'),
    ('strapdown: ö'.encode('latin-1'), 'is not UTF-8 text')]


@pytest.mark.parametrize('content, sentence', BAD_FILES)
def test_bad_files(tmp_path, content, sentence):
    """A bad parameter file is refused with a sentence that names the file."""
    path = tmp_path / 'bad.yaml'
    path.write_bytes(content)
    with pytest.raises(ValueError) as error:
        parameter_files.read([path])
    assert sentence in str(error.value)
    assert '\n' not in str(error.value)


def test_what_ros_allows_is_allowed(tmp_path):
    """Parameters of ROS itself are accepted, namespaces count, 1e-3 and 100 are numbers."""
    path = tmp_path / 'ok.yaml'
    path.write_text('/**:\n  ros__parameters: {use_sim_time: true, rate_hz: 50}\n'
                    '/robot/imu_sensor:\n  ros__parameters: {gyro: {delay_us: {x: 1e-3}}}\n')
    settings = parameter_files.read([path])
    assert settings.strapdown.rate_hz == 50.0
    assert settings.imu_sensor.gyro.delay_us.x == 0.001


@given(st.sampled_from(NUMBERS), st.floats())
def test_any_number_is_taken_or_refused_in_a_sentence(key, value):
    """No value gets past its bounds, and none raises anything but ValueError."""
    node, name = key
    f = flatten(NODES[node])[name]
    low, high = f.metadata['low'], f.metadata['high']
    try:
        settings = build(NODES[node], {name: value})
    except ValueError as error:
        assert str(error).startswith(name) or name.split('.')[-1] in str(error)
        assert not low <= value <= high
    else:
        assert values_of(settings)[name] == value and low <= value <= high


def test_every_number_has_bounds_and_a_doc():
    """The descriptors that ROS shows are complete."""
    for cls in NODES.values():
        for name, f in flatten(cls).items():
            assert f.metadata['doc'], name
            if f.type in (int, float):
                assert f.metadata['low'] is not None, name
    assert len(ALL_NAMES) > 60


def test_harmonics_need_as_many_phases():
    """A list of phases that does not fit is refused when the motion is made."""
    settings = parameter_files.read([], ['motion.kind:=harmonics', 'duration_s:=1.0',
                                         'motion.harmonics.psi_deg:=[1.0]'])
    with pytest.raises(ValueError, match='psi_phase_deg has 3 entries; expected 1'):
        run_offline(settings)


def test_endless_and_too_long_runs_are_refused(shared_data):
    """An offline run has a length, and a recording an end."""
    settings = parameter_files.read([], ['duration_s:=0.0'])
    with pytest.raises(ValueError, match='duration_s is 0, endless'):
        run_offline(settings)
    path = shared_data / 'flights' / 'uavcircuit_umn_thor_fl75.csv.gz'
    settings = parameter_files.read([], ['motion.kind:=recording', 'duration_s:=900.0',
                                         f'motion.recording.path:="{path}"'])
    with pytest.raises(ValueError, match='expected at most .* s, the end of the recording'):
        run_offline(settings)
    generator = replace(settings.motion_generator, duration_s=0.5)
    assert len(run_offline(replace(settings, motion_generator=generator)).errors) == 51


def test_an_assignment_may_name_its_node():
    """NODE:NAME:=VALUE sets the parameter of that node alone; an unknown node is reported."""
    settings = parameter_files.read_aided([], ['velocity_meter:seed:=7', 'gnss:seed:=8'])
    assert (settings.velocity_meter.seed, settings.gnss.seed) == (7, 8)
    assert settings.simulation.imu_sensor.seed == 0
    with pytest.raises(ValueError, match="-p meter:seed:=7: 'meter' is not a node of ins_sim; the "
                       "nearest is 'velocity_meter'"):
        parameter_files.read_aided([], ['meter:seed:=7'])


def told(paths, assignments=()):
    """Return the settings, and the warnings."""
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter('always')
        settings = parameter_files.read(paths, assignments)
    return settings, [str(one.message) for one in said]


def test_sections_of_other_nodes_are_ignored_with_a_word(tmp_path):
    """Sections of foreign nodes are ignored; one with a name similar to ours gives a warning."""
    path = tmp_path / 'p.yaml'
    path.write_text('/**/motion_generator: {ros__parameters: {duration_s: 2.0}}\n'
                    '/my_camera: {ros__parameters: {fps: 30}}\n'
                    'strapdwn: {ros__parameters: {rate_hz: 30.0}}\n'
                    + ''.join(f'c{k}: {{ros__parameters: {{a: 1}}}}\n' for k in range(9)))
    settings, said = told([path])
    assert settings.motion_generator.duration_s == 2.0 and settings.strapdown.rate_hz == 100.0
    assert said == [f'{path}: ignored, because no node of that name reads its parameters here: '
                    '/my_camera, /strapdwn (did you mean strapdown?), /c0 and 8 more']


@pytest.mark.parametrize('text, namespace', [
    ('/**: {motion_generator: {ros__parameters: {duration_s: 2.0}}}', ''),
    ('imu1: {motion_generator: {ros__parameters: {duration_s: 2.0}}}', '/imu1'),
    ('/imu1/*: {ros__parameters: {duration_s: 2.0}}', '/imu1'),
    ('/*: {ros__parameters: {duration_s: 2.0}}', '')])
def test_sections_within_sections(tmp_path, text, namespace):
    """Names of nodes and namespaces may be nested; a single namespace applies to all nodes."""
    path = tmp_path / 'p.yaml'
    path.write_text(text)
    settings, said = told([path])
    assert settings.motion_generator.duration_s == 2.0 and said == []
    path.write_text(f'{text}\n/imu2/strapdown: {{ros__parameters: {{output_every: 7}}}}\n'
                    '/strapdown: {ros__parameters: {output_every: 8}}')
    settings, said = told([path])
    assert settings.strapdown.output_every == 8
    assert len(said) == 1 and "are in the namespace '/': " in said[0]
    assert '/imu2/strapdown' in said[0] and (namespace in said[0])


def test_an_assignment_that_ros_overrules_is_said(tmp_path):
    """A section after /** overrides -p with a warning; NODE:NAME:=VALUE overrides the section."""
    path = tmp_path / 'prec.yaml'
    path.write_text('/**: {ros__parameters: {rate_hz: 100.0}}\n'
                    '/**/motion_generator: {ros__parameters: {duration_s: 0.2}}')
    settings, said = told([path], ['duration_s:=1.0', 'rate_hz:=50.0'])
    assert (settings.motion_generator.duration_s, settings.strapdown.rate_hz) == (0.2, 50.0)
    assert said == ['-p duration_s:=1.0: no effect on motion_generator, because, as in ROS 2, '
                    f'{path} sets it in a section that comes later, or with another type; '
                    'write -p motion_generator:duration_s:=1.0']
    other = tmp_path / 'other.yaml'
    other.write_text('/**: {ros__parameters: {duration_s: 7.0, rate_hz: 100}}')
    settings, said = told([path, other])
    assert (settings.motion_generator.duration_s, settings.strapdown.rate_hz) == (0.2, 100.0)
    assert said == [f'{other}: duration_s: no effect on motion_generator, because, as in ROS 2, '
                    f'{path} sets it in a section that comes later, or with another type']
    settings, said = told([path], ['motion_generator:duration_s:=1.0'])
    assert settings.motion_generator.duration_s == 1.0 and said == []
    path.write_text('imu1: {motion_generator: {ros__parameters: {duration_s: 0.2}}}')
    settings, said = told([path], ['motion_generator:duration_s:=1.0', 'duration_s:=3.0'])
    assert settings.motion_generator.duration_s == 3.0
    assert said == ["ignored, because the nodes are in the namespace '/imu1': /motion_generator"]
    assert parameter_files.read([path], {'duration_s': 1.0}).motion_generator.duration_s == 1.0


def test_texts_that_ros_takes_for_something_else(tmp_path):
    """A plain y is the axis y; dumped texts are read back as texts."""
    settings = parameter_files.read([], ['motion.coning.axis:=y', 'motion.recording.path:="1e5"'])
    assert settings.motion_generator.motion.coning.axis == 'y'
    path = tmp_path / 'p.yaml'
    path.write_text(parameter_files.dump(settings))
    assert "axis: 'y'" in path.read_text() and parameter_files.read([path]) == settings
