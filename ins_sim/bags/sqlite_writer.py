"""Write SQLite files of rosbag2 (.db3), schema version 4."""

import sqlite3

from . import mcap_format as form

SUFFIX = '.db3'
_SCHEMA = """
CREATE TABLE schema(schema_version INTEGER PRIMARY KEY, ros_distro TEXT NOT NULL);
CREATE TABLE metadata(id INTEGER PRIMARY KEY, metadata_version INTEGER NOT NULL,
                      metadata TEXT NOT NULL);
CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL,
                    serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL,
                    type_description_hash TEXT NOT NULL);
CREATE TABLE message_definitions(id INTEGER PRIMARY KEY, topic_type TEXT NOT NULL,
                                 encoding TEXT NOT NULL, encoded_message_definition TEXT NOT NULL,
                                 type_description_hash TEXT NOT NULL);
CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL,
                      timestamp INTEGER NOT NULL, data BLOB NOT NULL);
CREATE INDEX timestamp_idx ON messages (timestamp ASC);
INSERT INTO schema(schema_version, ros_distro) VALUES (4, 'jazzy');
"""
METADATA_VERSION = 9


class SqliteWriter:
    """
    One .db3 file, in which appended messages can be read immediately.

    While it is open, a write-ahead log next to it holds the newest messages, so that a killed
    writer leaves no half-written page.  Disk errors are raised as OSError.
    """

    def __init__(self, path, compression):
        if compression:
            raise ValueError(f'sqlite3 has no compression {compression!r}; expected none')
        open(path, 'xb').close()
        self._path, self._types = path, set()
        self._database = sqlite3.connect(path, isolation_level=None)
        self._run('PRAGMA journal_mode=WAL')
        # This protects against a crash of the process, but not of the machine.
        self._run('PRAGMA synchronous=OFF')
        for statement in _SCHEMA.strip().split(';\n'):
            self._run(statement)
        self.size = 0

    def _run(self, statement, values=()):
        try:
            return self._database.execute(statement, values).fetchall()
        except sqlite3.Error as error:
            raise _disk_error(error) from None

    def add_topic(self, channel):
        """Declare a Channel and the definition of its type."""
        self._run('BEGIN')
        self._run('INSERT INTO topics VALUES (?, ?, ?, ?, ?, ?)', (
            channel.id, channel.name, channel.type_name, channel.encoding, channel.qos,
            channel.type_hash))
        if channel.type_name not in self._types:
            self._types.add(channel.type_name)
            self._run('INSERT INTO message_definitions (topic_type, encoding, '
                      'encoded_message_definition, type_description_hash) VALUES (?, ?, ?, ?)', (
                          channel.type_name, channel.definition_encoding, channel.definition,
                          channel.type_hash))
        self._run('COMMIT')

    def append(self, records):
        """Write Records in one transaction."""
        view, head = records.data, form.MESSAGE_HEAD.size
        starts = records.starts.tolist()
        stops = [*starts[1:], len(records.data)]
        blobs = [view[a + head:b] for a, b in zip(starts, stops)]
        try:
            self._database.execute('BEGIN')
            self._database.executemany(
                'INSERT INTO messages (topic_id, timestamp, data) VALUES (?, ?, ?)',
                zip(records.channel.tolist(), records.log_ns.tolist(), blobs))
            self._database.execute('COMMIT')
        except sqlite3.Error as error:
            raise _disk_error(error) from None
        self.size += len(records.data)

    def close(self, metadata):
        """Write the metadata of rosbag2 (YAML), merge the write-ahead log, and close the file."""
        self._run('INSERT INTO metadata (metadata_version, metadata) VALUES (?, ?)',
                  (METADATA_VERSION, metadata))
        self._run('PRAGMA journal_mode=DELETE')
        self._database.close()

    def abort(self):
        """Close the file, keeping what was appended."""
        try:
            self._database.close()
        except sqlite3.Error:
            pass


def _disk_error(error):
    return OSError(str(error))
