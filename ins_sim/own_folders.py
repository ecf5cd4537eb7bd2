"""
Folders that a command writes: whole or not at all, by one command at a time, and nobody else's.

A folder of ours has a marker, which names what else is in it.  Only a folder that holds nothing
but that is ever replaced, by rename, once the new one is whole.
"""

from contextlib import contextmanager, suppress
import errno
import fcntl
import json
import os
from pathlib import Path
import shutil
import signal
import tempfile
import threading

MARKER = '.ins_sim'
HEAD = '# written by ins_sim; a folder that holds more than these names is never replaced\n'
# instead of names, of a folder that has none yet but that of its process
ANYTHING = '*'
HELD = (signal.SIGINT, signal.SIGTERM, signal.SIGALRM)
FOLDER_FLAGS = os.O_RDONLY | os.O_DIRECTORY


class OwnFolder:
    """
    A folder in writing, for this process alone.

    path: where it shall be; replace: take the place of a folder of ours that is there; in_place:
    grow under that name where nothing is there, so that what a killed process wrote can be read;
    else in ``work`` beside it.  mark: a name that a folder to be replaced must hold; option: how
    the caller spells replace.  The owner writes into ``work`` and ends with ``commit``,
    ``discard`` or ``close``.  Raises ValueError where check_free does, and where another
    process is writing there.
    """

    def __init__(self, path, replace=False, in_place=False, mark='', option='--force'):
        self._asked, self.path = path, _real(path)
        self._replace, self._mark, self._option = replace, mark, option
        check_free(path, replace, mark, option)
        beside = self.path.with_name(f'.{self.path.name}.part')
        self.work = self.path if in_place and not self.path.exists() else beside
        self._made, self._lock = _make_parents(self.path), None
        try:
            with _signals_held():
                self._claim()
                if self.work != self.path:
                    # another process may have come to its end between the first look and the claim
                    check_free(path, replace, mark, option)
                    self._check_idle()
                self.note(*([] if self.work == self.path else [ANYTHING]))
        except BaseException:
            if self._lock is not None:
                self.discard()
            self._drop_parents()
            raise

    def _claim(self):
        """Make the folder and lock it; the lock falls with the process, however it ends."""
        if self.work != self.path and self.work.exists():
            lock = self._locked(self.work)
            try:
                # left by a process that was killed
                if any(self.work.iterdir()) and ANYTHING not in (_own_names(self.work) or ()):
                    raise ValueError(f'{self.work} is in the way and not of ins_sim; expected it '
                                     'to be moved')
                shutil.rmtree(self.work)
            finally:
                os.close(lock)
        try:
            self.work.mkdir()
        except FileExistsError:
            raise self._busy() from None
        lock = self._locked(self.work)
        with suppress(FileNotFoundError):
            if os.path.samestat(os.fstat(lock), self.work.stat()):
                self._lock = lock
                return
        os.close(lock)
        raise self._busy()

    def _locked(self, folder):
        try:
            lock = os.open(folder, FOLDER_FLAGS)
        except FileNotFoundError:
            raise self._busy() from None
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            if error.errno in (errno.EWOULDBLOCK, errno.EACCES):
                os.close(lock)
                raise self._busy() from None
            # a file system without locks: the rename still lets only one of two end well
        return lock

    def _check_idle(self):
        """Raise ValueError where a process writes into the folder that is to be replaced."""
        if self.path.exists():
            os.close(self._locked(self.path))

    def _busy(self):
        return ValueError(f'{self._asked} is being written by another process; expected another '
                          'folder')

    def note(self, *names):
        """Put down names of entries as ours, before they are made."""
        fresh = not (self.work / MARKER).exists()
        _write_marker(self.work, 'a', HEAD * fresh, names)

    def commit(self):
        """Put the folder where it shall be, with all that is in it now as ours."""
        if self.work == self.path:
            self.close()
            return
        with _signals_held():
            self._take_place()

    def _take_place(self):
        _write_marker(self.work, 'w', HEAD, sorted(
            p.name for p in self.work.iterdir() if p.name != MARKER))
        old = None
        if self.path.exists() and any(self.path.iterdir()):
            check_free(self._asked, self._replace, self._mark, self._option)
            self._check_idle()
            # a folder gives way to another one only while it is empty
            old = Path(tempfile.mkdtemp(prefix=f'.{self.path.name}.old.', dir=self.path.parent))
            self.path.rename(old)
        try:
            self.work.rename(self.path)
        except OSError:
            if old is not None:
                old.rename(self.path)
            raise
        self.work = self.path
        self.close()
        if old is not None:
            _remove(old)

    def discard(self):
        """Delete what was written."""
        if self.work != self.path:
            # made by this process, under a name that nobody else uses
            shutil.rmtree(self.work, ignore_errors=True)
        else:
            _remove(self.work)
        self._drop_parents()
        self.close()

    def close(self):
        """Leave what was written as it is."""
        if self._lock is not None:
            os.close(self._lock)
            self._lock = None

    def _drop_parents(self):
        with suppress(OSError):
            for parent in self._made:
                parent.rmdir()


@contextmanager
def whole_folder(path, replace=False, mark='', option='--force'):
    """
    Give a folder to write into that takes the place of ``path`` once the block is through.

    Whatever breaks in the block leaves what was there before.  Raises as OwnFolder does.
    """
    folder = None
    try:
        with _signals_held():
            folder = OwnFolder(path, replace, mark=mark, option=option)
        yield folder.work
        folder.commit()
    except BaseException:
        if folder is not None and folder.work != folder.path:
            folder.discard()
        raise


def check_free(path, replace=False, mark='', option='--force'):
    """
    Raise ValueError unless a folder may be written: none is there, or one of ours and replace.

    mark: a name that it must hold; option: how the caller spells replace.
    """
    folder, here = _real(path), Path.cwd()
    if folder == Path(folder.root):
        raise ValueError(f'{path} is the root of all folders; expected a new folder')
    parent = existing_parent(folder)
    if not parent.is_dir() or not os.access(parent, os.W_OK):
        raise ValueError(f'{path} cannot be made in {parent}; expected a folder that may be '
                         'written')
    if not folder.exists():
        return
    if not replace:
        raise ValueError(f'{path} exists; expected a new folder (or {option})')
    if folder == here or folder in here.parents:
        raise ValueError(f'{path} holds the current folder, {here}; {option} replaces a folder as '
                         'a whole: call from outside it')
    foreign = _foreign(folder, mark)
    if foreign:
        raise ValueError(f'{path}: {foreign}; {option} replaces only what the same command wrote')


def existing_parent(folder):
    """Return the nearest folder above one that need not exist yet."""
    folder = _real(folder)
    return next(p for p in (*folder.parents, folder) if p.exists())


def _foreign(folder, mark=''):
    """Return why a folder is not ours, or '' where it holds nothing but what it names."""
    if not folder.is_dir():
        return 'it is no folder'
    names = sorted(p.name for p in folder.iterdir())
    if not names:
        return ''
    own = _own_names(folder)
    if own is None:
        return f'it has no marker {MARKER} of ins_sim'
    if mark and mark not in own:
        return f'it holds no {mark}'
    for name in names:
        entry = folder / name
        if name == MARKER:
            continue
        if name not in own:
            return f'it holds {name}, which ins_sim did not write'
        if entry.is_dir() and not entry.is_symlink():
            inner = _foreign(entry)
            if inner:
                return f'{name} in it: {inner}'
    return ''


def _own_names(folder):
    """Return the names in the marker of a folder, or None where there is none of ours."""
    try:
        head, *lines = (folder / MARKER).read_text(encoding='ascii').splitlines(keepends=True)
        names = {json.loads(line) for line in lines} if head == HEAD else None
        return names if names is None or all(Path(name).name == name for name in names) else None
    except (OSError, ValueError, TypeError):
        return None


def _remove(folder):
    """Delete a folder and what it names as ours; anything else stays, and the folder with it."""
    for name in _own_names(folder) or ():
        entry = folder / name
        if entry.is_dir() and not entry.is_symlink():
            _remove(entry)
        else:
            with suppress(OSError):
                entry.unlink()
    with suppress(OSError):
        if [p.name for p in folder.iterdir()] == [MARKER]:
            (folder / MARKER).unlink()
        folder.rmdir()


def _make_parents(folder):
    """Make the folders above one; return those that were not there, the deepest first."""
    missing = [p for p in folder.parents if not p.exists()]
    folder.parent.mkdir(parents=True, exist_ok=True)
    return missing


def _real(path):
    """Return an absolute path without links: what is renamed is the folder, not a link to it."""
    return Path(os.path.realpath(path))


@contextmanager
def _signals_held():
    """
    Put off what would break a step in two until the block is through.

    Not by a mask: threads of NumPy's libraries take signals too, and Python handles them here.
    """
    # in another thread than the main one Python handles none, and lets none be set
    main = threading.current_thread() is threading.main_thread()
    # a handler that is not of Python is given as None, and raises nothing
    held, before = [], {number: handler for number in HELD
                        if main and (handler := signal.getsignal(number)) is not None}
    try:
        for number in before:
            signal.signal(number, lambda number, frame: held.append(number))
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
        for number in held:
            signal.raise_signal(number)


def _write_marker(folder, mode, head, names):
    with open(folder / MARKER, mode, encoding='ascii') as marker:
        marker.write(head + ''.join(json.dumps(name) + '\n' for name in names))
