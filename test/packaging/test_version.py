"""Three files agree on the version, and bloom can read the changelog."""

import re
import xml.etree.ElementTree as ElementTree

from catkin_pkg.changelog import Changelog, populate_changelog_from_rst
import ins_sim
from support.places import ROOT

CHANGELOG = (ROOT / 'CHANGELOG.rst').read_text(encoding='utf-8')


def test_the_version_is_the_same_everywhere():
    """ins_sim/__init__.py, package.xml and the first heading of CHANGELOG.rst have one version."""
    package = ElementTree.parse(ROOT / 'package.xml').getroot()
    newest = re.search(r'^(\d+\.\d+\.\d+) \(\d{4}-\d\d-\d\d\)\n-+$', CHANGELOG, re.MULTILINE)
    assert package.findtext('version') == newest.group(1) == ins_sim.__version__


def test_the_changelog_has_the_format_of_catkin():
    """catkin_pkg finds the version with its date in the changelog, and the entries below it."""
    changelog = Changelog('ins_sim')
    populate_changelog_from_rst(changelog, CHANGELOG)
    versions = [(str(version), date.strftime('%Y-%m-%d'), len(entries))
                for version, date, entries in changelog.foreach_version()]
    assert versions[0][0] == ins_sim.__version__ and f'({versions[0][1]})' in CHANGELOG
    assert versions[0][2] > 0
