"""The files of config/view name existing topics, fields and frames with suitable types."""

import json
import xml.etree.ElementTree as ElementTree

from ins_sim.messages import placements, topics
from ins_sim.settings.catalogue import build
from ins_sim.settings.gnss import GnssSettings
from ins_sim.settings.place import Frames, ROLES
from ins_sim.settings.velocity_meter import VelocityMeterSettings
import pytest
from support.bags.messages import STORE
from support.places import ROOT
import yaml

VIEW = ROOT / 'config' / 'view'
TOPICS = {topic.name.lstrip('/'): topic for topic in (
    *topics.DATA, *topics.AIDING, *topics.BESIDE, *topics.GUIDANCE, topics.RUN, topics.TF,
    topics.TF_STATIC)}
FRAMES = {Frames().names()[role] for role in ROLES}
# Published by robot_state_publisher with transient local durability.
DESCRIPTION = 'robot_description'


def field_type(type_name, path):
    """Return the type of a field of a message, such as 'float64'; KeyError if there is none."""
    for name in path:
        # Layout of a definition: constants and fields, (name, (kind, base type or element)).
        fields = dict(STORE.fielddefs[type_name][1])
        _, type_name = fields[name]
    return type_name[0] if isinstance(type_name, tuple) else type_name


def displays(config):
    """Yield the displays of RViz, including those inside groups."""
    for display in config['Displays']:
        yield display
        if 'Displays' in display:
            yield from displays(display)


def test_rviz():
    """In RViz frames are those of ins_sim, topics are Odometry, and QoS matches the publishers."""
    manager = yaml.safe_load((VIEW / 'ins_sim.rviz').read_text())['Visualization Manager']
    views = manager['Views']
    assert manager['Global Options']['Fixed Frame'] == 'map'
    named = [view['Target Frame'] for view in (views['Current'], *views['Saved'])]
    shown = set()
    for display in displays(manager):
        named += [display[key] for key in ('Reference Frame',) if key in display]
        for key in ('Topic', 'Description Topic'):
            if key not in display:
                continue
            name, latched = display[key]['Value'], display[key]['Durability Policy']
            if name == DESCRIPTION:
                assert display['Class'] == 'rviz_default_plugins/RobotModel'
                assert latched == 'Transient Local'
                continue
            shown.add(name)
            assert (display['Class'], TOPICS[name].type_name) == (
                'rviz_default_plugins/Odometry', topics.ODOMETRY)
            assert latched == 'Volatile' and not TOPICS[name].latched
    assert set(named) <= FRAMES
    assert shown == {'truth/odometry', 'ins/odometry', 'aided/odometry'}


def leaves(layout):
    """Return the leaf panels of a Foxglove layout."""
    if isinstance(layout, str):
        return [layout]
    assert layout['direction'] in ('row', 'column') and 0 < layout['splitPercentage'] < 100
    return leaves(layout['first']) + leaves(layout['second'])


def check_3d(panel):
    """Check a 3D panel: Odometry, the robot description, and frames of ins_sim."""
    frames = [panel['followTf'], panel['fixedFrame'],
              *(layer['frameId'] for layer in panel['layers'].values()),
              *(name.removeprefix('frame:') for name in panel['transforms'])]
    assert set(frames) <= FRAMES
    for name in set(panel['topics']) - {f'/{DESCRIPTION}'}:
        assert TOPICS[name[1:]].type_name == topics.ODOMETRY


def check_plot(panel):
    """Check a plot: numeric fields of messages with a header, whose stamp is the abscissa."""
    assert panel['paths']
    for series in panel['paths']:
        topic, *path = series['value'].lstrip('/').split('.')
        type_name = TOPICS[topic].type_name
        assert field_type(type_name, path) == 'float64'
        assert series['timestampMethod'] == 'headerStamp'
        assert field_type(type_name, ['header', 'stamp', 'sec']) == 'int32'


def check_map(panel):
    """Check a map panel: topics of positions."""
    assert panel['followTopic'] in panel['topicColors']
    for name in panel['topicColors']:
        assert TOPICS[name[1:]].type_name == topics.FIX


def check_diagnostics(panel):
    """Check the panel of diagnostics."""
    assert panel['topicToRender'] == '/diagnostics'


def check_raw(panel):
    """Check a raw message panel: a topic of ins_sim."""
    assert panel['topicPath'][1:] in TOPICS


PANELS = {'3D': check_3d, 'Plot': check_plot, 'map': check_map,
          'DiagnosticSummary': check_diagnostics, 'RawMessages': check_raw}


def test_foxglove():
    """Every Foxglove panel is in the layout once and has a known type."""
    content = json.loads((VIEW / 'foxglove.json').read_text())
    assert sorted(leaves(content['layout'])) == sorted(content['configById'])
    for name, panel in content['configById'].items():
        PANELS[name.partition('!')[0]](panel)


def check_areas(node):
    """Check that each splitter of PlotJuggler has as many sizes as children."""
    for splitter in node.iter('DockSplitter'):
        sizes = [float(size) for size in splitter.get('sizes').split(';')]
        assert len(sizes) == int(splitter.get('count')) == len(splitter)
        assert sum(sizes) == pytest.approx(1.0, abs=1e-5)


def test_plotjuggler():
    """Curves of PlotJuggler are numeric fields of topics it subscribes to and reads from bags."""
    root = ElementTree.parse(VIEW / 'plotjuggler.xml').getroot()
    check_areas(root)
    tabs = root.findall('tabbed_widget/Tab')
    assert all(int(tab.get('containers')) == len(tab.findall('Container')) for tab in tabs)
    plots = [*root.iter('plot')]
    assert len(plots) == len([*root.iter('DockArea')])
    chosen = [plugin.find('selected_topics').get('value').split(';')
              for plugin in root.find('Plugins')]
    assert {plugin.get('ID') for plugin in root.find('Plugins')} == {
        'ROS2 Topic Subscriber', 'DataLoad ROS2 bags'}
    used = set()
    for curve in root.iter('curve'):
        names = [curve.get(key) for key in ('curve_x', 'curve_y') if curve.get(key)]
        for name in names or [curve.get('name')]:
            topic, = (t for t in TOPICS if name.startswith(f'/{t}/'))
            assert field_type(TOPICS[topic].type_name,
                              name.removeprefix(f'/{topic}/').split('/')) == 'float64'
            used.add(f'/{topic}')
    assert all(set(names) == used for names in chosen)
    # An XY plot has an abscissa and an ordinate, and other plots have neither.
    for plot in plots:
        assert {bool(curve.get('curve_x')) for curve in plot.iter('curve')} == {
            plot.get('mode') == 'XYPlot'}


def test_urdf():
    """The links of the URDF are frames on the vehicle, at the default positions of the nodes."""
    root = ElementTree.parse(VIEW / 'vehicle.urdf').getroot()
    links = {link.get('name') for link in root.iter('link')}
    assert links == FRAMES - {'map', 'odom'}
    mounted = {}
    for joint in root.iter('joint'):
        assert joint.get('type') == 'fixed'
        origin = joint.find('origin')
        numbers = [0.0] * 6 if origin is None else [
            float(text) for key in ('xyz', 'rpy') for text in origin.get(key, '0 0 0').split()]
        mounted[joint.find('child').get('link')] = (joint.find('parent').get('link'), numbers)
    for parent, child, pose in (placements.imu_mounting(None),
                                placements.gnss_mounting(build(GnssSettings, {})),
                                placements.meter_mounting(build(VelocityMeterSettings, {}))):
        assert mounted.pop(child) == (parent, [*pose[:3], 0.0, 0.0, 0.0])
        assert pose[3:] == (0.0, 0.0, 0.0, 1.0)
    assert not mounted
    materials = {material.get('name') for material in root.findall('material')}
    assert {material.get('name') for material in root.iter('material')} == materials


@pytest.mark.parametrize('name', ['ins_sim.rviz', 'foxglove.json', 'plotjuggler.xml',
                                  'vehicle.urdf'])
def test_the_page_says_how_to_open_it(name):
    """docs/how_to/viewing.md names each file of config/view, and there are no others."""
    assert name in (ROOT / 'docs' / 'how_to' / 'viewing.md').read_text()
    assert len([*VIEW.iterdir()]) == 4
