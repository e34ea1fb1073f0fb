#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Messages that clients cannot read unchanged, and messages after the server of the screens was killed.

usage: messages.py BIN_FOLDER ROOT [NAME]
"""
import pathlib
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / 'e2e'))
from rig import run_attacks  # noqa: E402  pylint: disable=wrong-import-position
from web import Screen as Server  # noqa: E402  pylint: disable=wrong-import-position
from web_screen import Screen  # noqa: E402  pylint: disable=wrong-import-position


class Reader(Screen):
    """A screen, and the time at which each message appeared on this computer."""

    def __init__(self, port):
        self.appeared = {}
        super().__init__(port)

    def take(self, told):
        super().take(told)
        if 'message' in told:
            self.appeared[told['message']['text']] = time.monotonic() - told.get('age_ms', 0) / 1000

    def has(self, *texts):
        return self.until(lambda: all(text in self.appeared for text in texts), 5)


def encoding(machine, found):
    """A message that is not valid UTF-8; readers receive it with the wrong bytes replaced."""
    path = machine.folder / 'latin.ngc'
    path.write_bytes(b'(MSG, \x85 gr\xfc\xdfe)\nM2\n')
    machine.open(path)
    machine.command.auto(machine.linuxcnc.AUTO_RUN, 1)
    told = machine.until(lambda: any('\ufffd gr\ufffd\ufffde' in text for text in machine.messages), 5)
    found.expect(told, 'the message of the program', machine.messages)


def restarted(machine, found):
    """Row 30: a server that was killed and restarted shows earlier messages and those sent during the restart, even if another
    client has read them."""
    def post(text):
        machine.command.error_msg(text)
        found.expect(machine.until(lambda: text in machine.messages, 5), f'Python reads "{text}"', machine.messages)
        return time.monotonic()

    server = Server(machine)
    try:
        screen = Reader(server.port)
        posted = {'before the kill': post('before the kill')}
        found.expect(screen.has(*posted), 'the screen shows the message', screen.appeared)
        first = {message['text']: message for message in screen.messages}
        server.kill()
        posted['meanwhile'] = post('meanwhile')
        machine.until(lambda: False, 2)
        server = Server(machine)
        screen = Reader(server.port)
        found.expect(screen.has(*posted), 'a screen of the next server shows both messages', screen.appeared)
        for text, at in posted.items():
            found.expect(abs(screen.appeared.get(text, 0) - at) < 0.3, f'"{text}" has the time at which it appeared', screen.appeared.get(text, 0) - at)
        again = [message for message in screen.messages if message['text'] == 'before the kill']
        found.expect(len(again) == 1 and again[0].get('run') and again == [first.get('before the kill')], 'it is known as the same message', again, first)
        found.expect(machine.linuxcnc.error_channel().poll() is None, 'a new error_channel of Python gets no message that was read')
    finally:
        server.kill()


if __name__ == '__main__':
    run_attacks(__file__, {'encoding': encoding, 'restarted': restarted})
