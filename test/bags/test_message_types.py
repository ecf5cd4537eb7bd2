"""The built-in replacement of rosbags gives equal definitions, hashes and transforms."""

import subprocess
import sys

from hypothesis import given, strategies as st
from ins_sim.bags.definitions import message_definition, TABLE
from ins_sim.messages.transforms import read_rotations
import pytest
from support.places import ROOT

typesys = pytest.importorskip('rosbags.typesys')
STORE = typesys.get_typestore(typesys.Stores.ROS2_JAZZY)
TF = 'tf2_msgs/msg/TFMessage'
TOOLS = ROOT / 'tools'
# Frame names of every length modulo eight occur, and so does every padding.
FRAMES = st.text(st.characters(exclude_characters='\0', exclude_categories=['Cs']), max_size=10)
NUMBERS = st.floats(allow_nan=False, width=64)
TRANSFORMS = st.lists(st.tuples(FRAMES, FRAMES, st.tuples(*[NUMBERS] * 4)), max_size=4)


def test_the_table_is_what_the_script_writes(monkeypatch):
    """`tools/make_message_types.py` generates exactly the committed file."""
    monkeypatch.syspath_prepend(str(TOOLS))
    import make_message_types
    assert make_message_types.text() == TABLE.read_text(encoding='utf-8')


def test_every_type_has_the_definition_and_hash_of_rosbags():
    """The text of a type is followed by those of its fields in the order of rosbags."""
    assert len(STORE.types) > 100
    for name in STORE.types:
        definition, _ = STORE.generate_msgdef(name, ros_version=2)
        assert message_definition(name) == (definition, STORE.hash_rihs01(name)), name


def test_an_unknown_type_is_one_sentence():
    """An unknown type is refused with one message; the recorder then asks ROS."""
    with pytest.raises(ValueError, match="the type 'my_msgs/msg/Thing' is not known"):
        message_definition('my_msgs/msg/Thing')


def test_definitions_need_no_library():
    """Definitions need only the standard library."""
    code = ('import sys; before = set(sys.modules); from ins_sim.bags import definitions; '
            'definitions.message_definition("sensor_msgs/msg/Imu"); '
            'print(*{n.partition(".")[0] for n in set(sys.modules) - before})')
    names = subprocess.run([sys.executable, '-c', code], capture_output=True, text=True,
                           check=True).stdout
    assert set(names.split()) <= set(sys.stdlib_module_names) | {'ins_sim'}


def packed(transforms):
    """Return a TFMessage serialized by rosbags."""
    def make(name, **values):
        return STORE.types[name](**values)

    stamp = make('builtin_interfaces/msg/Time', sec=1, nanosec=2)
    zero = make('geometry_msgs/msg/Vector3', x=1.0, y=2.0, z=3.0)
    message = make(TF, transforms=[make(
        'geometry_msgs/msg/TransformStamped', child_frame_id=child,
        header=make('std_msgs/msg/Header', stamp=stamp, frame_id=parent),
        transform=make('geometry_msgs/msg/Transform', translation=zero, rotation=make(
            'geometry_msgs/msg/Quaternion', **dict(zip('xyzw', q)))))
        for parent, child, q in transforms])
    return bytes(STORE.serialize_cdr(message, TF))


@given(TRANSFORMS)
def test_transforms_are_those_that_rosbags_packed(transforms):
    """Transforms with frames of any length and alphabet equal those packed by rosbags."""
    assert read_rotations(packed(transforms)) == transforms


@given(TRANSFORMS, st.data())
def test_a_cut_message_is_refused(transforms, draw):
    """A message cut anywhere raises a ValueError."""
    whole = packed(transforms)
    stop = draw.draw(st.integers(0, len(whole) - 1))
    with pytest.raises(ValueError):
        read_rotations(whole[:stop])


@given(st.binary(max_size=100))
def test_other_bytes_are_read_or_refused(data):
    """Random bytes are read or raise a ValueError, never another exception."""
    try:
        read_rotations(b'\0\1\0\0' + data)
    except ValueError:
        pass


def test_bytes_behind_the_last_transform_are_refused():
    """Up to three bytes behind the last transform are padding; more raise a ValueError."""
    whole = packed([('a', 'b', (0.0, 0.0, 0.0, 1.0))])
    assert read_rotations(whole + b'\0' * 3) == read_rotations(whole)
    with pytest.raises(ValueError, match='4 bytes after its last transform'):
        read_rotations(whole + b'\0' * 4)
    with pytest.raises(ValueError, match='expected the encapsulation of little-endian CDR'):
        read_rotations(b'\0\0' + whole[2:])
