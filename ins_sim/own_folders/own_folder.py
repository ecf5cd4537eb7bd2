"""Write a folder atomically, by one process at a time."""

from contextlib import contextmanager, suppress
import errno
import fcntl
import os
from pathlib import Path
import shutil
import tempfile

from .marker import ANYTHING, foreign, HEAD, MARKER, own_names, remove, write_marker
from .signals import signals_held

FOLDER_FLAGS = os.O_RDONLY | os.O_DIRECTORY


class OwnFolder:
    """
    An output folder that this process alone is writing.

    Write into ``work``, then call ``commit``, ``discard`` or ``close``.

    Parameters
    ----------
    path : final path
    replace : whether to replace an existing folder of ins_sim
    in_place : write under the final path if it is free, so that the output of a killed process
        can be read, instead of into a folder next to it
    mark : a name that a folder to be replaced must hold
    option : how the user spells ``replace``, for messages

    Attributes
    ----------
    path : final path, without links
    work : folder to write into

    Raises
    ------
    ValueError : as check_free, and if another process is writing there

    """

    def __init__(self, path, replace=False, in_place=False, mark='', option='--force'):
        self._asked, self.path = path, _real(path)
        self._replace, self._mark, self._option = replace, mark, option
        check_free(path, replace, mark, option)
        beside = self.path.with_name(f'.{self.path.name}.part')
        self.work = self.path if in_place and not self.path.exists() else beside
        self._made, self._lock = _make_parents(self.path), None
        try:
            with signals_held():
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
                # No process holds the folder: a killed one may have left it behind.
                if any(self.work.iterdir()) and ANYTHING not in (own_names(self.work) or ()):
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
            # This file system has no locks; of two processes only one will succeed in renaming.
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
        write_marker(self.work, 'a', HEAD * fresh, names)

    def commit(self):
        """Move the folder to its final path, with all entries in the marker, and release it."""
        if self.work == self.path:
            self.close()
            return
        with signals_held():
            self._take_place()

    def _take_place(self):
        write_marker(self.work, 'w', HEAD, sorted(
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
            remove(old)

    def discard(self):
        """Delete what was written."""
        if self.work != self.path:
            # This process created the folder, under a name that nothing else uses.
            shutil.rmtree(self.work, ignore_errors=True)
        else:
            remove(self.work)
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
        with signals_held():
            folder = OwnFolder(path, replace, mark=mark, option=option)
        yield folder.work
        folder.commit()
    except BaseException:
        if folder is not None and folder.work != folder.path:
            folder.discard()
        raise


def check_free(path, replace=False, mark='', option='--force'):
    """
    Check that path is free, or holds a folder of ins_sim that may be replaced.

    Parameters
    ----------
    path : path of the folder to be written
    replace, mark, option : see OwnFolder

    Raises
    ------
    ValueError : with what is in the way

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
    obstacle = foreign(folder, mark)
    if obstacle:
        raise ValueError(f'{path}: {obstacle}; {option} replaces only what the same command wrote')


def existing_parent(folder):
    """Return the nearest existing folder above a folder, which need not exist."""
    folder = _real(folder)
    return next(p for p in (*folder.parents, folder) if p.exists())


def _make_parents(folder):
    """Create the missing folders above one; return them, the deepest first."""
    missing = [p for p in folder.parents if not p.exists()]
    folder.parent.mkdir(parents=True, exist_ok=True)
    return missing


def _real(path):
    """Return an absolute path without links, so that a folder and not a link is renamed."""
    return Path(os.path.realpath(path))
