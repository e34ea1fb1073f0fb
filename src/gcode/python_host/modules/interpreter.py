# SPDX-License-Identifier: GPL-2.0-or-later
"""The interpreter's interface for remap handlers, O words and named parameters.

`this` is the interpreter that calls the script; handlers receive it as `self`. Lengths are in program units
(G20/G21), those of the tool table in machine units, angles in degrees. Only usable while a handler runs.
"""
import enum as _enum
import math as _math

import _millwright_script as _native


class _Number(_enum.IntEnum):
    """A number with a name; str() returns the name."""

    def __str__(self):
        return self.name

    def __repr__(self):
        return f'interpreter.{type(self).__name__}.{self.name}'


class InterpReturn(_Number):
    """Values that a handler returns or yields, and that execute() returns."""
    INTERP_OK = 0
    INTERP_EXIT = 1
    INTERP_EXECUTE_FINISH = 2
    INTERP_ENDFILE = 3
    INTERP_FILE_NOT_OPEN = 4
    INTERP_ERROR = 5


class CUTTER_COMP_DIRECTION(_Number):
    RIGHT = 1
    LEFT = 2


class DISTANCE_MODE(_Number):
    MODE_ABSOLUTE = 0
    MODE_INCREMENTAL = 1


class FEED_MODE(_Number):
    UNITS_PER_MINUTE = 0
    INVERSE_TIME = 1
    UNITS_PER_REVOLUTION = 2


class RETRACT_MODE(_Number):
    R_PLANE = 0
    OLD_Z = 1


class SPINDLE_MODE(_Number):
    CONSTANT_RPM = 0
    CONSTANT_SURFACE = 1


for _group in (InterpReturn, CUTTER_COMP_DIRECTION, DISTANCE_MODE, FEED_MODE, RETRACT_MODE, SPINDLE_MODE):
    globals().update(_group.__members__)

INTERP_MIN_ERROR = 3  # first code that is an error
TOLERANCE_EQUAL = 0.0001
throw_exceptions = 1  # execute() raises InterpreterException; 0: it returns INTERP_ERROR
this = None


def equal(a, b):
    return abs(a - b) < TOLERANCE_EQUAL


def nearest_int(value):
    return _math.floor(value + 0.5)


def is_near_int(value):
    return abs(value - nearest_int(value)) < TOLERANCE_EQUAL


class InterpreterException(Exception):
    """Raised when a block in execute() has failed."""

    def __init__(self, error_message, line_number=0, line_text=''):
        super().__init__(error_message)
        self.error_message = error_message
        self.line_number = line_number
        self.line_text = line_text


class PmCartesian:
    def __init__(self, x=0.0, y=0.0, z=0.0):
        self.x, self.y, self.z = x, y, z

    def __repr__(self):
        return f'PmCartesian(x={self.x:.4f} y={self.y:.4f} z={self.z:.4f})'


class EmcPose:
    """Nine coordinates. A change of self.tool_offset changes the interpreter's offset."""
    __slots__ = ('_values', '_store')

    def __init__(self, values=(0.0,) * 9, store=None):
        self._values = list(values)
        self._store = store

    @property
    def tran(self):
        return PmCartesian(*self._values[:3])

    def __iter__(self):
        return iter(self._values)

    def __repr__(self):
        return 'EmcPose(' + ' '.join(f'{n}={v:.4f}' for n, v in zip('xyzabcuvw', self._values)) + ')'


def _coordinate(index):
    def read(pose):
        return pose._values[index]

    def write(pose, value):
        pose._values[index] = float(value)
        if pose._store is not None:
            pose._store(tuple(pose._values))

    return property(read, write)


for _index, _name in enumerate('xyzabcuvw'):
    setattr(EmcPose, _name, _coordinate(_index))


class CANON_TOOL_TABLE:
    """One entry of the tool table, as read."""

    def __init__(self, toolno=-1, pocketno=0, offset=(0.0,) * 9, diameter=0.0, frontangle=0.0, backangle=0.0,
                 orientation=0, comment=''):
        self.toolno, self.pocketno, self.offset = toolno, pocketno, EmcPose(offset)
        self.diameter, self.frontangle, self.backangle = diameter, frontangle, backangle
        self.orientation, self.comment = orientation, comment

    def __repr__(self):
        return (f'CANON_TOOL_TABLE(toolno={self.toolno} pocketno={self.pocketno} offset={self.offset!r} '
                f'diameter={self.diameter:.4f} orientation={self.orientation})')


class _Array:
    """Items with indices from 0; IndexError after the end."""

    def __init__(self, size, read, write=None):
        self._size, self._read, self._write = size, read, write

    def __len__(self):
        return self._size

    def _check(self, index):
        if not 0 <= index < self._size:
            raise IndexError('index out of range')
        return index

    def __getitem__(self, index):
        return self._read(self._check(index))

    def __setitem__(self, index, value):
        if self._write is None:
            raise TypeError(f'{type(self).__name__} cannot be set')
        self._write(self._check(index), value)


class ActiveGcodesArray(_Array):
    pass


class ActiveMcodesArray(_Array):
    pass


class ActiveSettingsArray(_Array):
    pass


class GmodesArray(_Array):
    pass


class MmodesArray(_Array):
    pass


class BlocksArray(_Array):
    pass


class SubcontextArray(_Array):
    pass


class ParametersArray(_Array):
    pass


class SubroutineParamsArray(_Array):
    pass


class ToolTableArray(_Array):
    pass


class SpindleSpeedArray(_Array):
    pass


def _list(kind, items):
    return kind(len(items), items.__getitem__)


class Remap:
    """The definition of a remapped code."""

    def __init__(self, name, argspec, prolog, epilog, ngc, function, modal_group, motion_code):
        self.name, self.argspec = name, argspec or None
        self.prolog_func, self.epilog_func = prolog or None, epilog or None
        self.remap_ngc, self.remap_py = ngc or None, function or None
        self.modal_group, self.motion_code = modal_group, motion_code


class Block:
    """A block's words (x_flag, x_number, ...), codes, comment and arguments."""

    def __init__(self, data):
        values = data.pop('words')
        polar = data.pop('polar')
        for letter in 'abcdefhijklpqrstuvwxyz':
            missing = -1 if letter in 'hl' else (-1.0 if letter == 'q' else 0.0)
            missing = 0 if letter == 't' else missing
            value = values.get(letter, missing)
            if letter in 'hlt':
                value = nearest_int(value)
            setattr(self, f'{letter}_flag', letter in values)
            setattr(self, f'{letter}_number', value)
        self.d_number_float = float(self.d_number)
        remap = data.pop('remap')
        self.executing_remap = Remap(*remap) if remap else None
        self.g_modes = _list(GmodesArray, data.pop('g_modes'))
        self.m_modes = _list(MmodesArray, data.pop('m_modes'))
        self.params = _list(SubroutineParamsArray, data.pop('params'))
        self.o_name = data.pop('o_name') or None
        self.o_type, self.call_type, self.user_m, self.phase, self.offset = 0, 0, 0, 0, 0
        self.radius, self.theta = polar[0] or 0.0, polar[1] or 0.0  # the words @ and ^
        self.radius_flag, self.theta_flag = int(polar[0] is not None), int(polar[1] is not None)
        self.__dict__.update(data)


class ParameterValue:
    def __init__(self, value, attr):
        self.value, self.attr = value, attr


class map_indexing_suite_ParameterMap_entry:
    def __init__(self, name, value):
        self._name, self._value = name, value

    def key(self):
        return self._name

    def data(self):
        return self._value


class ParameterMap:
    """Named parameters of a call level, sorted; its items have key() and data()."""

    def __init__(self, items):
        self._items = dict(items)

    def __len__(self):
        return len(self._items)

    def __contains__(self, name):
        return name in self._items

    def __getitem__(self, name):
        return self._items[name]

    def __iter__(self):
        return (map_indexing_suite_ParameterMap_entry(*item) for item in sorted(self._items.items()))


class Context:
    """One call level: self.sub_context[0] is the main program, [self.call_level] the innermost level."""
    _READONLY, _GLOBAL, _COMPUTED, _INI, _SCRIPT = 1, 2, 8, 16, 32

    def __init__(self, data, predefined, scripted):
        def attributes(name):
            if name in scripted:
                return self._GLOBAL | self._READONLY | self._SCRIPT
            if name.startswith('_ini['):
                return self._GLOBAL | self._READONLY | self._INI
            if name in predefined:
                return self._GLOBAL | self._READONLY | self._COMPUTED
            return self._GLOBAL if name.startswith('_') else 0

        self.subname, self.filename = data['name'], data['file']
        self.sequence_number, self.position = data['line'], 0
        self.context_status, self.call_type = data['status'], data['kind']
        self.named_params = ParameterMap((name, ParameterValue(value, attributes(name)))
                                         for name, value in data['named'])
        self.saved_params = _list(SubroutineParamsArray, data['arguments'])
        g_codes, m_codes, settings = data['saved']
        self.saved_g_codes = _list(ActiveGcodesArray, g_codes)
        self.saved_m_codes = _list(ActiveMcodesArray, m_codes)
        self.saved_settings = _list(ActiveSettingsArray, settings)


class Params:
    """Parameters by number or name: params[31], params['local'], params['_global'], params['_ini[S]KEY']."""

    def __init__(self, view):
        self._view = view

    def __len__(self):
        return 5602

    def __call__(self):
        return self.locals() + self.globals()

    def locals(self):
        return self._view.locals()

    def globals(self):
        return self._view.globals()

    def __getitem__(self, key):
        if isinstance(key, str):
            value = self._view.named(key)
            if value is None:
                raise RuntimeError(f'parameter does not exist: {key}')
            return value
        if not isinstance(key, int):
            raise RuntimeError('params subscript type must be integer or string')
        return self._view.parameter(key)

    def __setitem__(self, key, value):
        if not isinstance(value, (int, float)):
            raise TypeError(f'a parameter needs a number, not {type(value).__name__}')
        if isinstance(key, str):
            self._view.set_named(key, value)
        elif isinstance(key, int):
            self._view.set_parameter(key, value)
        else:
            raise RuntimeError('params subscript type must be integer or string')


class Interp:
    """The interpreter. Attributes give its state by name; the script may define other attributes."""

    def __init__(self, view):
        object.__setattr__(self, '_view', view)
        object.__setattr__(self, '_names', frozenset(view.attribute_names()))
        object.__setattr__(self, 'params', Params(view))

    def __getattr__(self, name):
        if name.startswith('_') or name not in self._names:
            raise AttributeError(f"'Interp' object has no attribute '{name}'")
        return self._view.attribute(name)

    def __setattr__(self, name, value):
        if name in self._names:
            self._view.set_attribute(name, value)
        elif isinstance(getattr(type(self), name, None), property) or name == 'params':
            raise AttributeError(f'{name} cannot be set')
        else:
            object.__setattr__(self, name, value)

    def __dir__(self):
        return sorted(set(object.__dir__(self)) | self._names)

    # ---- running

    def execute(self, text, line=0):
        """Runs a block and its subroutines. After INTERP_EXECUTE_FINISH, yield before the next block."""
        code, message, line_number, line_text = self._view.execute(str(text), int(line))
        if code >= INTERP_MIN_ERROR and throw_exceptions:
            raise InterpreterException(message, line_number, line_text)
        if code >= INTERP_MIN_ERROR:
            self.set_errormsg(message)
        return code

    def set_errormsg(self, text):
        """Sets the message for a handler that returns INTERP_ERROR."""
        self._view.set_attribute('errormsg', str(text))

    def get_errormsg(self):
        return self._view.attribute('errormsg')

    def stack(self):
        return [f"{c['file']}:{c['line']}: {c['name']}" for c in self._view.contexts()[1:]]

    def synch(self):
        self._view.synch()
        return InterpReturn(0)

    # ---- state with more than one number

    @property
    def active_g_codes(self):
        return _list(ActiveGcodesArray, self._view.active_codes()[0])

    @property
    def active_m_codes(self):
        return _list(ActiveMcodesArray, self._view.active_codes()[1])

    @property
    def active_settings(self):
        return _list(ActiveSettingsArray, self._view.active_codes()[2])

    @property
    def speed(self):
        return SpindleSpeedArray(8, self._view.spindle_speed, self._view.set_spindle_speed)

    @property
    def parameters(self):
        return ParametersArray(5602, self._view.parameter, self._view.set_parameter)

    @property
    def blocks(self):
        levels = self._view.attribute('remap_level') + 1
        return BlocksArray(max(levels, 10), lambda level: Block(self._view.block(level)))

    @property
    def sub_context(self):
        contexts = self._view.contexts()
        predefined, scripted = frozenset(self._view.predefined()), frozenset(self._view.scripted())

        def read(level):
            return Context(contexts[level] if level < len(contexts) else self._view.no_context(), predefined,
                           scripted)

        return SubcontextArray(max(len(contexts), 10), read)

    # ---- tools

    @property
    def tool_offset(self):
        return EmcPose(self._view.tool_offset(), self._view.set_tool_offset)

    @tool_offset.setter
    def tool_offset(self, pose):
        self._view.set_tool_offset(tuple(pose))

    @property
    def tool_table(self):
        size = self._view.count_tools()

        def read(index):
            return CANON_TOOL_TABLE(*self._view.tool(index)) if index < size else CANON_TOOL_TABLE()

        return ToolTableArray(max(size, 1001), read)

    def find_tool_pocket(self, number):
        """Returns (INTERP_OK, index in the tool table), or (INTERP_ERROR, 0)."""
        index = self._view.find_tool(int(number))
        return (int(INTERP_OK), index) if index >= 0 else (int(INTERP_ERROR), 0)

    def load_tool_table(self):
        return InterpReturn(0)

    def set_tool_parameters(self):
        """Sets #5400 to #5413 to the data of the tool at current_pocket."""
        self._view.load_tool()
        return InterpReturn(0)
