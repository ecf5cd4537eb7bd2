"""Settings of the node recorder."""

from .field import group, setting, settings_class, SettingsGroup


@settings_class
class RecordSettings(SettingsGroup):
    """Recorded topics and log times."""

    topics: tuple[str, ...] = setting((), 'Names of the topics to record; a topic that does not '
                                      'exist yet is recorded once it appears')
    all_topics: bool = setting(False, 'Whether to record every topic that has a publisher, now or '
                               'later, except hidden ones')
    log_time: str = setting('stamp', 'Log time of a message. stamp: its header stamp, or, without '
                            'a header, the latest stamps received around it; received: the time '
                            'of reception, as rosbag2 does', choices=('stamp', 'received'))
    depth: int = setting(10000, 'Queue depth of each subscription', 'messages', 1, 1000000)


@settings_class
class StorageSettings(SettingsGroup):
    """The bag that is written."""

    path: str = setting('ins_sim_bag', 'Folder of the bag')
    format: str = setting('mcap', 'Storage format of the bag', choices=('mcap', 'sqlite3'))
    compression: str = setting('none', 'Compression of the chunks of an mcap file',
                               choices=('none', 'lz4', 'zstd'))
    split_mb: float = setting(0.0, 'File size at which a new file is begun; 0 = never', 'MB', 0.0,
                              1e9)
    split_s: float = setting(0.0, 'Span of log times at which a new file is begun; 0 = never', 's',
                             0.0, 1e9)
    replace: bool = setting(False, 'Whether an existing bag is replaced once the new one is '
                            'complete; otherwise it is an error')


@settings_class
class RecorderSettings(SettingsGroup):
    """Settings of the node recorder."""

    record: RecordSettings = group(RecordSettings)
    storage: StorageSettings = group(StorageSettings)

    def check(self):
        """Raise ValueError if no topic is selected."""
        if not self.record.topics and not self.record.all_topics:
            raise ValueError('record.topics is empty and record.all_topics false; expected topics '
                             'to record')
