"""Shared by recorder tests: messages to send, and the summary printed at the end."""

import re
import signal
import time


def end(chain, recorder, number=signal.SIGINT, code=0):
    """End a recorder; return {topic: (type, recorded, losses)} as it prints them."""
    recorder.send_signal(number)
    assert recorder.wait(30.0) == code, chain.text(recorder)
    return summary(chain.text(recorder))


def summary(text):
    """Return {topic: (type, recorded, rest)} from the lines printed at the end."""
    assert 'Traceback' not in text, text
    return {name: (kind, int(count), rest) for name, kind, count, rest in re.findall(
        r'\]: (/\S+) \((\S+)\): (\d+) recorded, (.*)', text)}


def send(publisher, messages, wait_s=0.2):
    """Publish no faster than DDS accepts, then wait until the messages have arrived."""
    for message in messages:
        publisher.publish(message)
        time.sleep(1e-4)
    time.sleep(wait_s)
