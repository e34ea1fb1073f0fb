# SPDX-License-Identifier: GPL-2.0-or-later
"""mdro: the values and functions of a digital read-out, its pins, and the server of its page.

Scales count in the unit of the machine (inch or mm). Offsets of coordinate systems are stored in this unit; values are shown in
the selected unit. Letters A, B and C are degrees. Nothing is written to files: all settings are lost when the program ends, as
with a read-out that is switched off.
"""
import argparse
import http.server
import json
import math
import os
import pathlib
import re
import secrets
import signal
import subprocess
import sys
import threading

from .language import Parser
from .mdro_page import PAGE

NAME = 'mdro'
LETTERS = 'XYZABCUVW'
ROTARY = 'ABC'
MM_PER_INCH = 25.4
SYSTEMS = ('machine', 'G54', 'G55', 'G56', 'G57')
# Parameters of G-code: X of the first coordinate system, and the distance to the next system.
FIRST_PARAMETER, PARAMETERS_EACH = 5221, 20
LARGEST_REQUEST = 4096


class Refused(Exception):
    """An action that is not possible, with a text for the operator."""


def offsets_of(path, axes):
    """{system: offsets} of a parameter file. Raises ValueError with the faulty line, or OSError."""
    offsets = {system: [0.0] * len(axes) for system in SYSTEMS}
    for number, line in enumerate(pathlib.Path(path).read_text().splitlines(), 1):
        words = line.split('#')[0].split()
        if not words:
            continue
        try:
            parameter, value = int(words[0]), float(words[1])
            if not math.isfinite(value):
                raise ValueError
        except (ValueError, IndexError):
            raise ValueError(f'{path}:{number}: "{line.strip()}" is no parameter and its value') from None
        system, letter = divmod(parameter - FIRST_PARAMETER, PARAMETERS_EACH)
        if 0 <= system < len(SYSTEMS) - 1 and letter < len(LETTERS) and LETTERS[letter] in axes:
            offsets[SYSTEMS[system + 1]][axes.index(LETTERS[letter])] = value
    return offsets


class Readout:
    """Values of the axes in a coordinate system and unit, and the functions of the buttons."""

    def __init__(self, axes, scales_mm, offsets, scale, index):
        """scale(n): position of the scale of an axis. index(n[, value]): whether it waits for its index; `value` starts or ends
        the wait."""
        self.axes, self.scales_mm, self.offsets, self.scale, self.index = axes, scales_mm, offsets, scale, index
        self.system, self.mm = SYSTEMS[1], scales_mm
        self.guard = threading.Lock()

    def factor(self, axis):
        if self.axes[axis] in ROTARY or self.mm == self.scales_mm:
            return 1.0
        return MM_PER_INCH if self.mm else 1 / MM_PER_INCH

    def value(self, axis):
        """The displayed value; None if the scale does not report a number."""
        scale = self.scale(axis)
        return (scale - self.offsets[self.system][axis]) * self.factor(axis) if math.isfinite(scale) else None

    def state(self):
        with self.guard:
            return {'axes': [{'letter': letter, 'value': self.value(n), 'index': bool(self.index(n)), 'rotary': letter in ROTARY}
                             for n, letter in enumerate(self.axes)],
                    'system': self.system, 'systems': SYSTEMS, 'mm': self.mm}

    def do(self, request):
        """{"do": zero | half | set | index | system | units, "axis": N, "value": number or text}."""
        with self.guard:
            what = request.get('do')
            if what == 'units':
                self.mm = request.get('value') == 'mm'
            elif what == 'system':
                if request.get('value') not in SYSTEMS:
                    raise Refused(f'there is no coordinate system {request.get("value")}')
                self.system = request['value']
            elif what in ('zero', 'half', 'set', 'index'):
                self.do_axis(what, request)
            else:
                raise Refused(f'{what} is nothing that it does')

    def do_axis(self, what, request):
        axis = request.get('axis')
        if not isinstance(axis, int) or isinstance(axis, bool) or not 0 <= axis < len(self.axes):
            raise Refused(f'there is no axis {axis}')
        if what == 'index':
            self.index(axis, not self.index(axis))
            return
        if self.system == SYSTEMS[0]:
            raise Refused('machine coordinates cannot be changed: choose G54 to G57')
        now = self.value(axis)
        if now is None:
            raise Refused(f'the scale of {self.axes[axis]} is not a number')
        wanted = {'zero': 0.0, 'half': now / 2}.get(what, request.get('value'))
        if isinstance(wanted, bool) or not isinstance(wanted, (int, float)) or not math.isfinite(wanted):
            raise Refused(f'{wanted} is no number')
        self.offsets[self.system][axis] = self.scale(axis) - wanted / self.factor(axis)


def handler_of(readout, token, point_size, verbose):
    """Answers requests for /TOKEN/ only, because other pages and other users of the computer do not know the token."""
    class Handler(http.server.BaseHTTPRequestHandler):
        protocol_version = 'HTTP/1.1'
        timeout = 30  # s: for a connection without data

        def answer(self, status, text, kind='application/json'):
            body = text.encode()
            self.send_response(status)
            for name, value in (('Content-Type', kind + '; charset=utf-8'), ('Content-Length', str(len(body))), ('Cache-Control', 'no-store'),
                                ('X-Frame-Options', 'DENY'), ('Referrer-Policy', 'no-referrer')):
                self.send_header(name, value)
            self.end_headers()
            self.wfile.write(body)

        def do_GET(self):
            if self.path == f'/{token}/':
                self.answer(200, PAGE.replace('POINT_SIZE', str(point_size)), 'text/html')
            elif self.path == f'/{token}/state':
                self.answer(200, json.dumps(readout.state()))
            else:
                self.answer(404, 'not here', 'text/plain')

        def do_POST(self):
            try:
                length = int(self.headers.get('Content-Length', ''))
            except ValueError:
                length = -1
            if self.path != f'/{token}/do' or not 0 <= length <= LARGEST_REQUEST:
                self.close_connection = True
                self.answer(404, 'not here', 'text/plain')
                return
            try:
                request = json.loads(self.rfile.read(length))
                if not isinstance(request, dict):
                    raise Refused('no request')
                readout.do(request)
                self.answer(200, json.dumps(readout.state()))
            except (Refused, ValueError) as error:
                self.answer(400, json.dumps({'refused': str(error)}))

        def log_message(self, form, *words):
            if verbose > 1 or (verbose and self.command == 'POST'):
                print(f'{NAME}: {self.command} {form % words}'.replace(token, '...'), file=sys.stderr, flush=True)
    return Handler


def axes_of(text):
    axes = text.upper()
    if not axes or set(axes) - set(LETTERS) or len(set(axes)) != len(axes):
        raise argparse.ArgumentTypeError(f"'{text}': letters of {LETTERS}, each once")
    return axes


def size_of(text):
    if not text.isdigit() or not 6 <= int(text) <= 200:
        raise argparse.ArgumentTypeError(f"'{text}': 6 to 200")
    return int(text)


def settings(words, doc):
    """Options, including those of the INI file if one is named."""
    parser = Parser(prog=NAME, usage=doc.split('usage: ')[1].split('\n')[0],
                    description='A digital readout for manual machines: shows the positions of the scales in a browser on this computer.')
    parser.add_argument('-v', action='count', default=0, dest='verbose', help='verbose output; twice: also all requests')
    parser.add_argument('-p', type=size_of, default=None, dest='point_size', metavar='POINT_SIZE', help='size of the text (20)')
    parser.add_argument('-m', action='store_true', dest='mm', help='the scales count mm, not inches')
    parser.add_argument('-l', dest='var', metavar='FILE.var', help='offsets of G54 to G57 at the start')
    parser.add_argument('-ini', dest='ini', metavar='FILE', help='INI file of the machine with this program as DISPLAY')
    parser.add_argument('--port', type=int, default=0, help='port of the page (0: a free port)')
    parser.add_argument('axes', nargs='?', type=axes_of, default=None, metavar='AXES')
    options = parser.parse_args(words)
    options.postgui = []
    if options.ini:
        take_ini(parser, options)
    options.axes, options.point_size = options.axes or 'XYZ', options.point_size or 20
    try:
        options.offsets = offsets_of(options.var or os.devnull, options.axes)
    except (OSError, ValueError) as error:
        parser.error(f'{options.var}: {error.strerror}' if isinstance(error, OSError) else str(error))
    return options


def take_ini(parser, options):
    import linuxcnc
    ini = linuxcnc.ini(options.ini)
    geometry, size, folder = ini.find('DISPLAY', 'GEOMETRY'), ini.find('DISPLAY', 'POINT_SIZE'), pathlib.Path(options.ini).parent
    try:
        # The key also describes pictures of machines: "XYZ-B!".
        options.axes = options.axes or (axes_of(re.sub('[^' + LETTERS + ']', '', geometry.upper())) if geometry else None)
        options.point_size = options.point_size or (size_of(size) if size else None)
    except argparse.ArgumentTypeError as error:
        parser.error(f'{options.ini}: [DISPLAY] {error}')
    options.mm = options.mm or (ini.find('DISPLAY', 'MM') or '').strip().lower() in ('1', 'yes', 'true', 'on')
    var = ini.find('DISPLAY', 'MDRO_VAR_FILE')
    options.var = options.var or (str(folder / var) if var else None)
    options.postgui = [str(folder / name) for name in ini.findall('HAL', 'POSTGUI_HALFILE')]


def join_hal(options):
    """Creates the component with its pins, and the read-out that uses them."""
    import hal
    component = hal.component(NAME)
    scales = [component.newpin(f'axis.{n}', hal.HAL_FLOAT, hal.HAL_IN) for n in range(len(options.axes))]
    indexes = [component.newpin(f'index-enable.{n}', hal.HAL_BIT, hal.HAL_IO) for n in range(len(options.axes))]

    asked = set()

    def index(n, *value):
        if value:
            indexes[n].value = value[0]
            (asked.add if value[0] else asked.discard)(n)
        return indexes[n].value

    def leave():
        """Cancels all index searches that were requested here."""
        for n in asked:
            indexes[n].value = False
    readout = Readout(options.axes, options.mm, options.offsets, lambda n: scales[n].value, index)
    return component, readout, leave


def main(words, doc):
    options = settings(words, doc)
    try:
        component, readout, leave = join_hal(options)
    except ImportError as error:
        sys.exit(f'{NAME}: {error}')
    token = secrets.token_urlsafe(12)
    try:
        handler = handler_of(readout, token, options.point_size, options.verbose)
        server = http.server.ThreadingHTTPServer(('127.0.0.1', options.port), handler)
    except (OSError, OverflowError) as error:
        sys.exit(f'{NAME}: port {options.port}: {error}')
    server.daemon_threads = True
    address = f'http://127.0.0.1:{server.server_port}/{token}/'
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(0))
    component.ready()
    for path in options.postgui:
        if subprocess.run(['halcmd', '-i', options.ini, '-f', path], check=False).returncode:
            sys.exit(f'{NAME}: {path} failed, which [HAL]POSTGUI_HALFILE names')
    print(f'{NAME}: {address}', file=sys.stderr, flush=True)
    if os.environ.get('DISPLAY') or os.environ.get('WAYLAND_DISPLAY'):
        try:
            subprocess.Popen(['xdg-open', address], stdin=subprocess.DEVNULL, start_new_session=True)
        except OSError:
            print(f'{NAME}: no xdg-open shows it: open the address in a browser', file=sys.stderr)
    try:
        server.serve_forever()
    except KeyboardInterrupt:
        pass
    finally:
        leave()
    return 0
