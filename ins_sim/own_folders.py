"""
Write output folders atomically, by one process at a time, without deleting foreign files.

A folder written by ins_sim has a marker file, which lists the other entries.  Only a folder that
holds nothing else is ever replaced, by renaming, once the new one is complete.
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
# Entry of the marker in an unfinished folder, which may hold any names.
ANYTHING = '*'
HELD = (signal.SIGINT, signal.SIGTERM, signal.SIGALRM)
FOLDER_FLAGS = os.O_RDONLY | os.O_DIRECTORY


class OwnFolder:
    """
    An output folder that this process alone is writing.

    path: final path; replace: replace an existing folder of ins_sim; in_place: write under the
    final path if it is free, so that the output of a killed process can be read, instead of in
    a folder ``work`` next to it; mark: a name that a folder to be replaced must hold; option:
    how the user spells replace.  Write into ``work``, then call ``commit``, ``discard`` or
    ``close``.  Raises ValueError as check_free, and if another process is writing there.
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
                    # Another process may have finished between the first check and the claim.
                    check_free(path, replace, mark, option)
                    self._check_idle()
                self.note(*([] if self.work == self.path else [ANYTHING]))
        except BaseException:
            if self._lock is not None:
                self.discard()
            self._drop_parents()
            raise

    def _claim(self):
        """Create and lock the folder; the lock is released when the process ends in any way."""
        if self.work != self.path and self.work.exists():
            lock = self._locked(self.work)
            try:
                # The folder was left behind by a killed process.
                if any(self.work.iterdir()) and ANYTHING not in (_own_names(self.work) or ()):
                    raise ValueError(f'{self.work} is in the way and was not written by ins_sim; '
                                     'expected it to be moved')
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
            # This file system has no locks; of two processes only one will succeed to rename.
        return lock

    def _check_idle(self):
        """Raise ValueError if a process is writing into the folder that will be replaced."""
        if self.path.exists():
            os.close(self._locked(self.path))

    def _busy(self):
        return ValueError(f'{self._asked} is being written by another process; expected another '
                          'folder')

    def note(self, *names):
        """Add names of entries to the marker, before the entries are created."""
        fresh = not (self.work / MARKER).exists()
        _write_marker(self.work, 'a', HEAD * fresh, names)

    def commit(self):
        """Move the folder to its final path and list all its entries in the marker."""
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
            # Only an empty folder can be replaced by a rename.
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
            # This process created the folder, under a name that nothing else uses.
            shutil.rmtree(self.work, ignore_errors=True)
        else:
            _remove(self.work)
        self._drop_parents()
        self.close()

    def close(self):
        """Release the folder and keep what was written."""
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
    Yield a folder to write into, which replaces ``path`` at the end of the block.

    After an exception in the block ``path`` is unchanged.  Raises the same as OwnFolder.
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
    Raise ValueError unless path is free, or holds a folder of ins_sim and replace is true.

    mark: a name that such a folder must hold; option: how the user spells replace.
    """
    folder, here = _real(path), Path.cwd()
    if folder == Path(folder.root):
        raise ValueError(f'{path} is the root of all folders; expected a new folder')
    parent = existing_parent(folder)
    if not parent.is_dir() or not os.access(parent, os.W_OK):
        raise ValueError(f'{path} cannot be made in {parent}; expected a writable '
                         'folder')
    if not folder.exists():
        return
    if not replace:
        raise ValueError(f'{path} exists; expected a new folder (or {option})')
    if folder == here or folder in here.parents:
        raise ValueError(f'{path} holds the current folder, {here}; {option} replaces a folder as '
                         'a whole: run it from outside this folder')
    foreign = _foreign(folder, mark)
    if foreign:
        raise ValueError(f'{path}: {foreign}; {option} replaces only what the same command wrote')


def existing_parent(folder):
    """Return the nearest existing folder above a folder, which need not exist."""
    folder = _real(folder)
    return next(p for p in (*folder.parents, folder) if p.exists())


def _foreign(folder, mark=''):
    """Return why a folder must not be replaced, or '' if it holds only entries of its marker."""
    if not folder.is_dir():
        return 'it is not a folder'
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
    """Return the names in the marker of a folder, or None without a valid marker."""
    try:
        head, *lines = (folder / MARKER).read_text(encoding='ascii').splitlines(keepends=True)
        names = {json.loads(line) for line in lines} if head == HEAD else None
        return names if names is None or all(Path(name).name == name for name in names) else None
    except (OSError, ValueError, TypeError):
        return None


def _remove(folder):
    """Delete the entries of the marker, and the folder itself if nothing else is in it."""
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
    """Create the missing folders above one; return them, the deepest first."""
    missing = [p for p in folder.parents if not p.exists()]
    folder.parent.mkdir(parents=True, exist_ok=True)
    return missing


def _real(path):
    """Return an absolute path without links, so that a folder and not a link is renamed."""
    return Path(os.path.realpath(path))


@contextmanager
def _signals_held():
    """
    Delay signals that would interrupt a step until the end of the block.

    A signal mask would not do: threads of NumPy's libraries receive signals as well.
    """
    # Python handles signals, and allows handlers to be set, only in the main thread.
    main = threading.current_thread() is threading.main_thread()
    # A handler that was not set by Python is None here; it raises no exception.
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
