"""The command navigate on invalid recordings: one message and exit code 2."""

import numpy as np
import pytest
from support.recordings import FIX, fix_messages, IMU, imu_messages, STORE, TF, write_bag
from rosbags.rosbag2 import StoragePlugin, Writer

from ins_sim.cli.main import main
from support.readings.imu_records import resting


@pytest.mark.parametrize('data', [b'', b'\0\1\0\0', b'\0\1\0\0\xff\xff\xff\x7f',
                                  b'\0\1\0\0' * 9])
def test_transforms_that_are_none_are_one_sentence(data, tmp_path, capsys):
    """Bytes that are not a TFMessage are reported in one message with topic and time."""
    bag = tmp_path / 'bag'
    with Writer(bag, version=9, storage_plugin=StoragePlugin.MCAP) as writer:
        for name, type_name in (('/imu', IMU), ('/tf_static', TF)):
            connection = writer.add_connection(name, type_name, typestore=STORE)
            if type_name == TF:
                writer.write(connection, 5, data)
            else:
                for log_ns, content in resting():
                    writer.write(connection, log_ns, STORE.serialize_cdr(content, type_name))
    assert main(['navigate', str(bag), '-o', str(tmp_path / 'out')]) == 2
    error = capsys.readouterr().err
    assert '/tf_static has a message at 5 ns that is not a tf2_msgs/msg/TFMessage' in error
    assert error.count('\n') == 1


IMU_ONLY = dict(t_ns=np.arange(1000) * 20_000_000, omega=np.zeros((1000, 3)),
                f=np.tile([0.0, 0.0, 9.8], (1000, 1)))


def shaken():
    """Return IMU messages of a sensor that is never at rest."""
    rng = np.random.default_rng(0)
    return imu_messages(IMU_ONLY['t_ns'], rng.standard_normal((1000, 3)),
                        IMU_ONLY['f'] + 5.0 * rng.standard_normal((1000, 3)))


def nan_at_rest():
    """Return messages without a finite angular rate."""
    return resting(omega=np.full((1000, 3), np.nan))


BAD = [
    ({('/fix', FIX): fix_messages([0], [0.7], [0.0], [0.0])}, [],
     'has no sensor_msgs/Imu; it has /fix'),
    ({('/a', IMU): resting(), ('/b', IMU): resting()}, [],
     'has 2 topics of sensor_msgs/Imu: /a, /b; expected topic to name one'),
    ({('/imu', IMU): resting(), ('/fix', FIX): []}, ['topic:=fix'],
     '/fix, the value of topic, has type sensor_msgs/NavSatFix; expected sensor_msgs/Imu'),
    ({('/imu', IMU): resting()}, ['topic:=imo'],
     "has no topic 'imo', the value of topic; the nearest is '/imu'"),
    ({('/imu', IMU): []}, [], '/imu is empty; expected messages'),
    ({('/imu', IMU): nan_at_rest()}, [], '1000 of them not finite'),
    ({('/imu', IMU): shaken()}, [], 'no stationary interval of 5 s'),
    ({('/imu', IMU): resting()}, [], 'the latitude is unknown'),
    ({('/imu', IMU): resting()}, ['initial.position:=given'], 'the heading is unknown'),
    ({('/imu', IMU): resting()}, ['initial.position:=given', 'initial.heading:=gyrocompass'],
     'too coarse'),
    ({('/imu', IMU): resting(5)}, [], 'expected at least 10 samples after the start'),
    ({('/imu', IMU): resting()}, ['start_s:=100.0'], 'start_s is 100 s'),
    ({('/imu', IMU): resting()}, ['initial.attitude:=imu'], 'hold no orientation'),
    ({('/imu', IMU): resting()}, ['initial.attitude:=reference'], 'no reference has an attitude'),
    ({('/imu', IMU): resting()}, ['initial.attitude:=given', 'initial.position:=given'],
     'no reference has a velocity'),
    ({('/imu', IMU): resting()}, ['mounting.source:=tf'], 'no /tf_static'),
    ({('/imu', IMU): resting()}, ['initial.position:=given', 'initial.heading:=given',
                                  'vertical.channel:=damped'], 'no reference has a height'),
    ({('/imu', IMU): resting()}, ['initial.heading_deg:=88.0'],
     'initial.heading_deg is 88.0 and would not be used; expected initial.heading'),
    ({('/imu', IMU): resting()}, ['mounting.source:=level', 'mounting.rpy_deg:=[90.0, 0.0, 0.0]'],
     'would not be used with mounting.source level; expected a yaw alone'),
    ({('/imu', IMU): resting()}, ['inital.heading:=given'],
     "the nearest known one is 'initial.heading'"),
    ({('/imu', IMU): resting()}, ['reference.path:=absent.csv'], 'absent.csv'),
    ({('/imu', IMU): resting() + resting(frame='other')}, [],
     "the frames 'imu_link' (1000 messages), 'other' (1000 messages)"),
]


@pytest.mark.parametrize('recorded, assignments, sentence', BAD, ids=range(len(BAD)))
def test_bad_input_is_one_sentence_and_exit_code_2(recorded, assignments, sentence, tmp_path,
                                                   capsys):
    """Invalid bags give one message and exit code 2, and nothing is written."""
    bag, out = write_bag(tmp_path / 'bag', recorded), tmp_path / 'out'
    arguments = [word for a in assignments for word in ('-p', a)]
    assert main(['navigate', str(bag), '-o', str(out), *arguments]) == 2
    error = capsys.readouterr().err
    assert sentence in error and error.startswith('ins_sim navigate: ')
    assert error.count('\n') == 1
    assert not out.exists()


@pytest.mark.parametrize('make, sentence', [
    (lambda p: None, 'does not exist; expected a rosbag2 bag or a CSV file'),
    (lambda p: p.mkdir(), 'is not a bag'),
    (lambda p: p.write_text('x'), 'is not a bag')])
def test_a_path_that_is_no_bag(make, sentence, tmp_path, capsys):
    """A missing path, an empty folder and another file are refused with one message."""
    make(tmp_path / 'bag')
    assert main(['navigate', str(tmp_path / 'bag'), '-o', str(tmp_path / 'out')]) == 2
    error = capsys.readouterr().err
    assert sentence in error and error.count('\n') == 1


@pytest.mark.parametrize('text, sentence', [
    ('t_s,gx_rps\n0,1\n', 'has no column gy_rps'),
    ('t_s,gx_rps,gy_rps,gz_rps,ax_mps2,ay_mps2,az_mps2\n', 'has a header but no rows'),
    ('t_s,gx_rps,gy_rps,gz_rps,ax_mps2,ay_mps2,az_mps2\n0,1,2,x,4,5,6\n', "gz_rps is 'x'"),
    ('t_s,gx_rps,gy_rps,gz_rps,ax_mps2,ay_mps2,az_mps2\n,1,2,3,4,5,6\n', 't_s is blank'),
    ('t_s,gx_rps,gy_rps,gz_rps,ax_mps2,ay_mps2,az_mps2\n0,1,2,3,4,5\n', '6 fields; expected 7'),
    ('', 'is empty')])
def test_bad_csv_is_named_by_its_line(text, sentence, tmp_path, capsys):
    """Invalid CSV gives one message with file and line."""
    path = tmp_path / 'imu.csv'
    path.write_text(text)
    assert main(['navigate', str(path), '-o', str(tmp_path / 'out')]) == 2
    error = capsys.readouterr().err
    assert sentence in error and 'imu.csv' in error and error.count('\n') == 1
