"""The verbs list and describe: all shipped files are listed, all parameters described."""

from pathlib import Path

from ins_sim import resources
from ins_sim.cli import describe, listing, main as command, shipped_files
from ins_sim.cli.known_settings import READERS
from ins_sim.cli.main import main
from ins_sim.settings.catalogue import flatten, value_text
import pytest
from support.places import ROOT

NAMES = sorted(path.stem for path in (ROOT / 'config').glob('*.yaml'))


def listed(*words, capsys):
    """Return {name: line} of the output of list, and the headings."""
    assert main(['list', *words]) == 0
    lines = capsys.readouterr().out.splitlines()
    rows = [line.split(maxsplit=1) for line in lines if line.startswith(' ')]
    assert len({name for name, _ in rows}) == len(rows) or not words
    return rows, [line for line in lines if line and not line.startswith(' ')]


def test_every_shipped_file_is_listed_once(capsys):
    """Every shipped file is listed once: in a pipe with one line of at least four words."""
    rows, heads = listed(capsys=capsys)
    verbs = {name for name, _ in listing.study_verbs()}
    assert sorted(name for name, _ in rows if name not in verbs) == NAMES
    assert len(heads) == len(listing.KINDS) + 1
    for _, words in rows:
        assert len(words.split()) > 3 and words[-1] not in '.,:;' and len(words) <= 160


def test_lists_by_kind(capsys):
    """The lists of all kinds together equal the full list; motions can be simulated."""
    found = [name for kind in listing.KINDS for name, _ in listed(kind, capsys=capsys)[0]]
    assert sorted(found) == sorted(name for name, _ in listed(capsys=capsys)[0])
    motions, instruments, studies, others = (
        dict(listed(kind, capsys=capsys)[0]) for kind in listing.KINDS)
    assert {'motion_1', 'racetrack', 'route_flight', 'recorded_flight'} <= set(motions)
    assert {'imu_tactical_fog', 'grade_mid', 'delay_y_1us'} <= set(instruments)
    assert {'dtg_study_speed', 'allan'} <= set(studies)
    assert {'default', 'navigate', 'real_imu', 'other_simulator'} == set(others)
    assert studies['dtg_study_speed'].startswith('dtg-study: Table 2')


def test_the_verbs_that_are_studies_are_those_of_the_command():
    """The studies listed are the verbs of the package studies, by the names of their files."""
    rooms = {name for name, verb in command.VERBS.items() if '.studies.' in verb.__name__}
    assert {name for name, _ in listing.study_verbs()} == rooms
    assert all(main.HELP == words for name, words in listing.study_verbs()
               for main in [command.VERBS[name]])


def test_lines_fit_into_a_terminal():
    """Lines are folded at 80 columns with aligned text."""
    files = shipped_files.shipped_files()
    parts = [(shipped_files.HEADS[kind], [(file.name, file.words) for file in files[kind]])
             for kind in listing.KINDS]
    told = listing.lines(parts, 80)
    assert max(map(len, told)) <= 80
    margin = len(max(NAMES, key=len)) + listing.INDENT + 2
    assert all(line[:margin].isspace() or line[margin - 1] == ' ' != line[margin]
               for line in told if line.startswith(' '))


def test_every_parameter_is_described():
    """Every parameter is described with its default, for every node and verb that has it."""
    for reader, cls in READERS.items():
        for name, f in flatten(cls).items():
            text = '\n'.join(describe.described(name))
            assert f'{name}: {value_text(f.default)}' in ' '.join(text.split()), (reader, name)
            assert reader in text, (reader, name)
            assert max(map(len, text.splitlines())) <= max(80, len(name) + 5)


def test_every_section_of_the_shipped_files_has_a_reader():
    """describe knows every section and parameter of the shipped files, also of new studies."""
    for name in NAMES:
        for node, key, _ in shipped_files.shipped_file(name).values:
            assert node == '**' or key in flatten(READERS[node]), (name, node, key)


@pytest.mark.parametrize('name', NAMES)
def test_every_shipped_file_is_described(name):
    """The description of a shipped file has its comment and each parameter that it sets."""
    text = '\n'.join(describe.described(name))
    file = shipped_files.shipped_file(name)
    assert str(resources.config(name)) in text and all(line in text for line in file.head)
    assert all(f'  {key}: ' in text for _, key, _ in file.values)


def test_a_group(capsys):
    """A group is described with units, bounds, defaults, nodes, and what is set at run time."""
    assert main(['describe', 'gyro.errors']) == 0
    said = capsys.readouterr().out
    assert said.startswith('gyro.errors  (imu_sensor, strapdown)\n    Errors of the gyro triad.')
    words = ' '.join(said.split())
    assert ('gyro.errors.bias_deg_h: [0.0, 0.0, 0.0] Bias, the same in every '
            'run [deg/h]; -1e+09 to 1e+09; can be set while imu_sensor runs') in words
    assert 'accelerometer' not in said


@pytest.mark.parametrize('name, first, inside', [
    ('gyro.delay_us.y', 'gyro.delay_us.y: 0.0  (imu_sensor)', '[us]; -1e+06 to 1e+06'),
    ('strapdown', 'strapdown\n    Settings of the node strapdown', 'initial.source: '),
    ('motion.kind', 'motion.kind: racetrack', 'one of static, rocking'),
    ('dtg_study', 'dtg_study', 'sweep: '), ('navigate', '', 'initial.heading: '),
    ('imu_tactical_fog', '', 'gyro.errors.turn_on_bias_sigma_deg_h: [')])
def test_other_names(name, first, inside, capsys):
    """Parameters, nodes, commands and files can be described."""
    assert main(['describe', name]) == 0
    said = capsys.readouterr().out
    assert said.startswith(first) and inside in ' '.join(said.split())
    assert not said.startswith('\n')


def test_without_a_name_the_groups_are_described(capsys):
    """Without a name all groups are described with their nodes."""
    assert main(['describe']) == 0
    said = capsys.readouterr().out
    assert 'gyro  (imu_sensor)' in said and '\nmotion  (motion_generator, imu_sensor' in said


@pytest.mark.parametrize('name, sentence', [
    ('gyro.erors', "the nearest known one is 'gyro.errors'"),
    ('racetrak', "the nearest known one is 'racetrack'"),
    ('imu_sensr', "the nearest known one is 'imu_sensor'"),
    ('delay_us.y', 'there are accelerometer.delay_us.y, gyro.delay_us.y'),
    ('bias_deg_h', 'there are gyro.dtg.fault.bias_deg_h, gyro.errors.bias_deg_h'),
    ('x' * 5000, '(5000 characters) is not a parameter'), ('', "'' is not a parameter"),
    ('gyro.', "the nearest known one is 'gyro'"), ('\x1b[2J', 'is not a parameter')])
def test_unknown_names(name, sentence, capsys):
    """An unknown name gives one message and exit code 2."""
    assert main(['describe', name]) == 2
    error = capsys.readouterr().err
    assert sentence in error and error.count('\n') == 1 and '\x1b' not in error


def test_an_unknown_kind(capsys):
    """list with an unknown kind shows the usage of the command."""
    with pytest.raises(SystemExit) as end:
        main(['list', 'motion'])
    assert end.value.code == 2 and 'motions' in capsys.readouterr().err


def test_files_of_the_repository_are_those_that_are_found():
    """list reads the same folder as simulate."""
    assert resources.config_names() == NAMES
    assert Path(resources.config(NAMES[0])).parent == ROOT / 'config'
