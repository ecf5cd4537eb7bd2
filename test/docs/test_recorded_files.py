"""The page on recordings of others: its example is read, and its parameters exist."""

import json
import re

import numpy as np
from support.places import ROOT

from ins_sim.cli.main import main
from ins_sim.settings.catalogue import flatten
from ins_sim.settings.navigate import NavigateSettings

PAGE = (ROOT / 'docs' / 'how_to' / 'recorded_files.md').read_text(encoding='utf-8')
HEADER = ('Time (s),Gyroscope X (deg/s),Gyroscope Y (deg/s),Gyroscope Z (deg/s),'
          'Accelerometer X (g),Accelerometer Y (g),Accelerometer Z (g)')


def test_the_example_of_the_page_reads_the_file_it_is_for(tmp_path):
    """The example converts deg/s and g by a parameter file: at rest the IMU measures gravity."""
    parameters = re.search(r'```yaml\n(.*?)```', PAGE, re.DOTALL).group(1)
    (tmp_path / 'map.yaml').write_text(parameters)
    noise = 1e-3 * np.random.default_rng(2).standard_normal((2000, 6))
    rows = '\n'.join(f'{0.01 * k:.2f},' + ','.join(f'{x:.6f}' for x in row + [0, 0, 0, 0, 0, 1])
                     for k, row in enumerate(noise))
    (tmp_path / 'imu.csv').write_text(f'{HEADER}\n{rows}\n')
    imu, params, out = (str(tmp_path / name) for name in ('imu.csv', 'map.yaml', 'out'))
    assert main(['navigate', imu, '--params-file', params, '-o', out,
                 '-p', 'initial.position:=given', '-p', 'initial.heading:=given',
                 '-p', 'alignment.longest_s:=10.0']) == 0
    summary = json.loads((tmp_path / 'out' / 'summary.json').read_text())
    assert abs(summary['figures']['gravity_excess_m_s2'] - (9.80665 - 9.78033)) < 1e-3


def test_every_parameter_of_the_page_is_one_of_navigate():
    """Every parameter named on the page is a parameter of navigate."""
    names = set(re.findall(r'`((?:accept|stamps|units|alignment|columns)\.[a-z_0-9]+)', PAGE))
    assert len(names) > 10 and names <= set(flatten(NavigateSettings))
