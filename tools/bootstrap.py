"""
Create .venv with ins_sim and its dependencies, if it is missing, and run a command in it.

Usage: python3 tools/bootstrap.py [command [argument ...]]

The script uses only the standard library and runs on any Python 3, so that an old one can report
that it is too old. If ROS 2 is sourced, its rclpy and libraries are used, which locked versions
would overlay; otherwise everything is installed from PyPI, with the versions and hashes of
requirements.lock.
"""

import sys
try:
    import fcntl
    import hashlib
    import json
    import os
    import platform
    import shutil
    import signal
    import subprocess
except KeyboardInterrupt:
    sys.exit(130)

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
VENV = os.path.join(ROOT, '.venv')
VENV_BIN = os.path.join(VENV, 'bin')
STAMP = os.path.join(VENV, 'ins_sim-stamp.json')
LOCK = os.path.join(ROOT, 'requirements.lock')
OLDEST = (3, 10)
# Platforms for which wheels of rclpy exist.
WHEEL_PYTHONS = ((3, 10), (3, 14))
WHEEL_GLIBC = (2, 28)
PROBE = """
import json, platform, sys
try:
    import ensurepip, venv
    has_venv = True
except ImportError:
    has_venv = False
try:
    import rclpy
    has_rclpy = True
except ImportError:
    has_rclpy = False
try:
    from numpy import __version__ as numpy
except ImportError:
    numpy = None
print(json.dumps({'executable': sys.executable, 'version': sys.version_info[:3],
                  'libc': platform.libc_ver(), 'machine': platform.machine(),
                  'system': sys.platform, 'venv': has_venv, 'rclpy': has_rclpy, 'numpy': numpy}))
"""


def say(sentence):
    """Print a sentence for the user."""
    print('ins_sim: ' + sentence, file=sys.stderr, flush=True)


def probe(python):
    """Return the facts about an interpreter, or None if it does not run."""
    try:
        output = subprocess.check_output([python, '-c', PROBE], stderr=subprocess.DEVNULL,
                                         stdin=subprocess.DEVNULL)
        return json.loads(output.decode().splitlines()[-1])
    except (OSError, subprocess.CalledProcessError, ValueError, IndexError):
        return None


def ros_is_sourced():
    """Return whether a set-up script of ROS 2 ran in this shell."""
    return bool(os.environ.get('ROS_DISTRO') and os.environ.get('AMENT_PREFIX_PATH'))


def choose_python(with_ros):
    """Return the facts about the interpreter to build .venv on."""
    if with_ros:
        # rclpy is compiled for one Python: the system's, whichever python3 comes first in PATH.
        for python in (sys.executable, '/usr/bin/python3'):
            facts = probe(python)
            if facts and facts['rclpy'] and tuple(facts['version'][:2]) >= OLDEST:
                return facts
        # Wheels next to the libraries of a sourced ROS would mix the two.
        sys.exit('ins_sim: ROS 2 {0} is sourced, but neither {1} nor /usr/bin/python3 is a Python '
                 '3.10 or newer that imports rclpy: install ros-{0}-rclpy, or use a shell without '
                 'ROS to get rclpy from PyPI'.format(os.environ['ROS_DISTRO'], sys.executable))
    for python in (sys.executable, 'python3.13', 'python3.12', 'python3.11', 'python3.10'):
        facts = probe(python)
        if facts and tuple(facts['version'][:2]) >= OLDEST:
            return facts
    sys.exit('ins_sim: Python 3.10 or newer is needed, this is {}, and PATH holds none of '
             'python3.13 to python3.10'.format(platform.python_version()))


def wheels_fit(facts):
    """Return whether PyPI has wheels of rclpy for the interpreter."""
    libc, libc_version = facts['libc']
    return (facts['system'] == 'linux' and facts['machine'] == 'x86_64' and libc == 'glibc'
            and tuple(int(part) for part in libc_version.split('.')[:2]) >= WHEEL_GLIBC
            and WHEEL_PYTHONS[0] <= tuple(facts['version'][:2]) <= WHEEL_PYTHONS[1])


def read_stamp():
    """Return the stamp of the last complete installation, empty if there was none."""
    try:
        with open(STAMP) as stream:
            return json.load(stream)
    except (OSError, ValueError):
        return {}


def digest_of_requirements():
    """Return a digest of the files that determine what pip installs."""
    digest = hashlib.sha256()
    for path in (os.path.join(ROOT, 'setup.py'), LOCK):
        with open(path, 'rb') as stream:
            digest.update(hashlib.sha256(stream.read()).digest())
    return digest.hexdigest()


def venv_environment(with_ros):
    """Return the environment of a command that runs in .venv."""
    env = dict(os.environ)
    old = env.get('VIRTUAL_ENV')
    if not with_ros:
        # The wheels' start-up hook leaks its guard and its library path to children; in another
        # environment the first hides, and the second mixes, the compiled libraries.
        env.pop('_ROS_WHEELS_BOOTSTRAP_COMPLETE', None)
        if old:
            parts = [part for part in env.get('LD_LIBRARY_PATH', '').split(os.pathsep)
                     if part and not part.startswith(os.path.join(old, ''))]
            env['LD_LIBRARY_PATH'] = os.pathsep.join(parts)
    env.pop('PYTHONHOME', None)
    env['VIRTUAL_ENV'] = VENV
    env['PATH'] = VENV_BIN + os.pathsep + env.get('PATH', os.defpath)
    return env


def install(facts, with_ros, fresh):
    """Install the package into .venv, which is created anew if fresh is true."""
    python = os.path.join(VENV_BIN, 'python')
    if fresh:
        if not facts['venv']:
            sys.exit('ins_sim: {} cannot make virtual environments: install the Debian or Ubuntu '
                     'package python{}.{}-venv'.format(facts['executable'], *facts['version']))
        shutil.rmtree(VENV, ignore_errors=True)
        options = ['--system-site-packages'] if with_ros else []
        run([facts['executable'], '-m', 'venv'] + options + [VENV], with_ros, 'making .venv')
    pip = [python, '-m', 'pip', 'install', '--quiet', '--no-input',
           '--disable-pip-version-check']
    locked = not with_ros and wheels_fit(facts)
    if with_ros:
        say('using rclpy of the sourced ROS 2 ' + os.environ['ROS_DISTRO'])
    elif not locked:
        say('PyPI has no rclpy for this machine (wheels exist for Linux on x86-64 with glibc 2.28 '
            'or newer and Python 3.10 to 3.14): installing without it and without '
            'requirements.lock, the nodes will not start')
    say('installing into .venv; this takes a minute or two and is done only once')
    if locked:
        run(pip + ['--require-hashes', '--requirement', LOCK], with_ros, 'installing')
        # Without isolation the package is built by the setuptools of the lock, and not by
        # whichever is the newest.
        run(pip + ['--no-deps', '--no-build-isolation', '--editable', ROOT], with_ros,
            'installing')
    else:
        limits = []
        if with_ros and facts['numpy']:
            # The messages of ROS are compiled for its NumPy: no library may bring another one.
            limits = ['--constraint', os.path.join(VENV, 'constraints.txt')]
            with open(limits[1], 'w') as stream:
                stream.write('numpy=={}\n'.format(facts['numpy']))
        # Wheels first, because there may be no compiler.
        run(pip + limits + ['--prefer-binary', '--editable', ROOT + '[test]'], with_ros,
            'installing')


def run(command, with_ros, doing):
    """Run a step of the set-up, or exit with a message."""
    # In a group of its own, so that Ctrl-C reaches this process alone: the step would print a
    # traceback.
    step = subprocess.Popen(command, env=venv_environment(with_ros), stdin=subprocess.DEVNULL,
                            cwd=ROOT, start_new_session=True)
    try:
        code = step.wait()
    except KeyboardInterrupt:
        os.killpg(step.pid, signal.SIGKILL)
        step.wait()
        raise
    if code != 0:
        sys.exit('ins_sim: {} failed, see above; the next call starts over'.format(doing))


def set_up():
    """Bring .venv up to date and return whether it uses the ROS of the system."""
    stamp = read_stamp()
    with_ros = ros_is_sourced()
    digest = digest_of_requirements()
    # Scripts carry absolute paths: a moved checkout needs a new environment.
    same_place = (stamp.get('venv') == VENV and stamp.get('with_ros') == with_ros
                  and os.path.exists(os.path.join(VENV_BIN, 'python')))
    if same_place and stamp.get('digest') == digest:
        return with_ros
    facts = choose_python(with_ros)
    if os.path.exists(STAMP):
        os.remove(STAMP)
    install(facts, with_ros, fresh=not same_place)
    # Written last: without it the next call regards .venv as incomplete and starts over.
    with open(STAMP, 'w') as stream:
        json.dump({'venv': VENV, 'with_ros': with_ros, 'digest': digest}, stream)
    return with_ros


def main():
    """Set up .venv, then replace this process by the command."""
    with open(VENV + '.lock', 'w') as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        with_ros = set_up()
    command = sys.argv[1:]
    if not command:
        say('.venv is ready')
        return
    env = venv_environment(with_ros)
    os.environ['PATH'] = env['PATH']
    try:
        os.execvpe(command[0], command, env)
    except OSError as error:
        sys.exit('ins_sim: cannot run {}: {}'.format(command[0], error.strerror))


def started():
    """Run ``main``; after an interruption exit with one message."""
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        main()
    except KeyboardInterrupt:
        say('interrupted; the next call goes on or starts over')
        sys.exit(130)


if __name__ == '__main__':
    started()
