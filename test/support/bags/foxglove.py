"""A minimal client of Foxglove's WebSocket protocol."""

import base64
import json
import os
import socket
import struct

PROTOCOL = 'foxglove.sdk.v1'
GUARD_S = 60.0
TEXT, BINARY, PING, PONG = 1, 2, 9, 10
# Opcode of a message in a binary frame, subscription, log time in ns.
_MESSAGE = struct.Struct('<BIQ')


class FoxgloveClient:
    """
    Client connected to a server on this machine; use it as a context manager.

    channels: {topic: description} as advertised so far; received: {topic: (log time ns, bytes)} of
    the last message of each topic.
    """

    def __init__(self, port):
        self.channels, self.received, self._topics = {}, {}, {}
        self._socket = socket.create_connection(('127.0.0.1', port), GUARD_S)
        key = base64.b64encode(os.urandom(16)).decode()
        self._socket.sendall((f'GET / HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nUpgrade: websocket\r\n'
                              f'Connection: Upgrade\r\nSec-WebSocket-Key: {key}\r\n'
                              'Sec-WebSocket-Version: 13\r\n'
                              f'Sec-WebSocket-Protocol: {PROTOCOL}\r\n\r\n').encode())
        self._stream = self._socket.makefile('rb')
        assert b' 101 ' in self._stream.readline()
        while self._stream.readline().strip():
            pass

    def __enter__(self):
        return self

    def __exit__(self, *exception):
        self._stream.close()
        self._socket.close()

    def _send(self, opcode, data):
        # A client must mask the data it sends; a mask of zeros leaves them unchanged.
        length = bytes([0x80 | len(data)]) if len(data) < 126 else (
            bytes([0x80 | 126]) + struct.pack('>H', len(data)))
        self._socket.sendall(bytes([0x80 | opcode]) + length + bytes(4) + data)

    def _frame(self):
        first, second = self._stream.read(2)
        assert first & 0x80, 'a message in pieces'
        length = second & 0x7f
        if length == 126:
            length, = struct.unpack('>H', self._stream.read(2))
        elif length == 127:
            length, = struct.unpack('>Q', self._stream.read(8))
        return first & 0x0f, self._stream.read(length)

    def _step(self):
        opcode, data = self._frame()
        if opcode == PING:
            self._send(PONG, data)
        elif opcode == TEXT:
            said = json.loads(data)
            if said['op'] == 'advertise':
                self.channels.update((channel['topic'], channel) for channel in said['channels'])
        elif opcode == BINARY and data[0] == 1:
            _, number, log_ns = _MESSAGE.unpack_from(data)
            self.received[self._topics[number]] = log_ns, data[_MESSAGE.size:]

    def wait_channels(self, names):
        """Receive frames until all these topics are advertised."""
        while not set(names) <= set(self.channels):
            self._step()

    def subscribe(self, names):
        """Subscribe to topics."""
        self._topics = dict(enumerate(names))
        for number, name in self._topics.items():
            self._send(TEXT, json.dumps({'op': 'subscribe', 'subscriptions': [
                {'id': number, 'channelId': self.channels[name]['id']}]}).encode())

    def wait_messages(self, names):
        """Receive frames until every topic has a message."""
        while not set(names) <= set(self.received):
            self._step()
