"""Settings of the node recorder: what goes into a bag, and how."""

from .field import group, setting, settings_class, SettingsGroup


@settings_class
class RecordSettings(SettingsGroup):
    """What is recorded, and at which time."""

    topics: tuple[str, ...] = setting((), 'names of topics; one that is not there yet is waited '
                                      'for')
    all_topics: bool = setting(False, 'every topic that has a publisher, now or later, but no '
                               'hidden one')
    log_time: str = setting('stamp', 'when a message is logged. stamp: at the stamp of its '
                            'header, and one without at the stamps heard around it; received: '
                            'when it came, as rosbag2 does', choices=('stamp', 'received'))
    depth: int = setting(10000, 'queue depth of each subscription', 'messages', 1, 1000000)


@settings_class
class StorageSettings(SettingsGroup):
    """The bag."""

    path: str = setting('ins_sim_bag', 'folder of the bag')
    format: str = setting('mcap', 'kind of its files', choices=('mcap', 'sqlite3'))
    compression: str = setting('none', 'compression of the chunks of mcap',
                               choices=('none', 'lz4', 'zstd'))
    split_mb: float = setting(0.0, 'begin another file where one is as large; 0 = never', 'MB',
                              0.0, 1e9)
    split_s: float = setting(0.0, 'begin another file where the log times of one span as much; '
                             '0 = never', 's', 0.0, 1e9)
    replace: bool = setting(False, 'replace a bag that is there once the new one is whole; else '
                            'refuse')


@settings_class
class RecorderSettings(SettingsGroup):
    """Node recorder."""

    record: RecordSettings = group(RecordSettings)
    storage: StorageSettings = group(StorageSettings)

    def check(self):
        """Refuse to record nothing."""
        if not self.record.topics and not self.record.all_topics:
            raise ValueError('record.topics is empty and record.all_topics false; expected topics '
                             'to record')
