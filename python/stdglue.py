# SPDX-License-Identifier: GPL-2.0-or-later
"""Prologs and epilogs for remapped codes: T, M6, M61, S, F and cycles.

In remap.py: `from stdglue import *`. A prolog checks the block and passes values to the procedure as local parameters. The
procedure may change them, and returns a positive number if the epilog should apply them. If the procedure has used the code
itself, the epilog adds nothing.
"""
import emccanon
from interpreter import INTERP_EXECUTE_FINISH, INTERP_OK

_CYCLE_WORDS = 'xyzabcuvwrqpl'
_PLANE_XY, _PLANE_YZ, _PLANE_XZ = 1, 2, 3
_FAULT, _FAULT_CODE = 5600, 5601  # parameters in which a tool changer reports a fault


def _block(self):
    return self.blocks[self.remap_level]


def _refusal(self, name):
    """The error if a procedure did not return a positive number, otherwise None."""
    if self.return_value > 0.0:
        return None
    return f'{name}: aborted (return code {self.return_value:.1f})'


def _changer_fault(self, name):
    """The text of a hard fault of the changer; a soft fault is shown, and the change continues."""
    if self.params[_FAULT] <= 0.0:
        return None
    code = self.params[_FAULT_CODE]
    if code < 0.0:
        return f'{name}: the tool changer reports fault {code:.0f}'
    emccanon.MESSAGE(f'{name}: the tool changer reports {code:.0f}')
    return None


def _find_tool(self, tool, name):
    """(index in the tool table, None), or (None, error)."""
    status, pocket = self.find_tool_pocket(tool)
    if status != INTERP_OK:
        return None, f'{name}: tool {tool} is not in the tool table'
    return pocket, None


# ---------------------------------------------------------------------------------------------- T: prepare

def prepare_prolog(self, **words):
    """Sets #<tool> and #<pocket> (-1 for T0)."""
    block = _block(self)
    if not block.t_flag:
        return 'T requires a tool number'
    pocket = -1
    if block.t_number:
        pocket, error = _find_tool(self, block.t_number, f'T{block.t_number}')
        if error:
            return error
    self.params['tool'] = block.t_number
    self.params['pocket'] = pocket
    return INTERP_OK


def prepare_epilog(self, **words):
    tool = int(self.params['tool'])
    error = _refusal(self, f'T{tool}')
    if error or _block(self).builtin_used:
        return error
    self.selected_tool = tool
    self.selected_pocket = 0 if tool == 0 else int(self.params['pocket'])
    emccanon.SELECT_TOOL(tool)
    return INTERP_OK


# -------------------------------------------------------------------------------------------- M6: change

def change_prolog(self, **words):
    """Sets #<tool_in_spindle>, #<selected_tool>, #<current_pocket> and #<selected_pocket>."""
    fault = _changer_fault(self, 'M6')
    if fault:
        return fault
    if self.selected_pocket < 0:
        return 'M6: no tool prepared'
    if self.cutter_comp_side:
        return 'Cannot change tools with cutter radius compensation on'
    self.params['tool_in_spindle'] = self.current_tool
    self.params['selected_tool'] = self.selected_tool
    self.params['current_pocket'] = self.current_pocket
    self.params['selected_pocket'] = self.selected_pocket
    return INTERP_OK


def change_epilog(self, **words):
    error = _refusal(self, 'M6') or _changer_fault(self, 'M6')
    if error:
        yield error
    if not _block(self).builtin_used:
        pocket = int(self.params['selected_pocket'])
        if pocket != self.selected_pocket:  # the procedure has selected another tool
            emccanon.SELECT_TOOL(self.tool_table[pocket].toolno if pocket > 0 else 0)
        emccanon.CHANGE_TOOL(pocket)
        self.current_pocket = pocket
        self.selected_pocket = -1
        self.selected_tool = -1
        self.set_tool_parameters()
        self.toolchange_flag = True
    yield INTERP_EXECUTE_FINISH


# ------------------------------------------------------------------------------------- M61: set tool number

def settool_prolog(self, **words):
    """Gives #<tool> and #<pocket>."""
    block = _block(self)
    if not block.q_flag:
        return 'M61 requires a Q word'
    tool = int(block.q_number)
    if tool < 0:
        return 'M61: Q must be 0 or more'
    pocket = 0
    if tool:
        pocket, error = _find_tool(self, tool, 'M61')
        if error:
            return error
    self.params['tool'] = tool
    self.params['pocket'] = pocket
    return INTERP_OK


def settool_epilog(self, **words):
    error = _refusal(self, 'M61')
    if error or _block(self).builtin_used:
        if error:
            yield error
        return
    self.current_tool = int(self.params['tool'])
    self.current_pocket = int(self.params['pocket'])
    emccanon.CHANGE_TOOL_NUMBER(self.current_tool)
    self.set_tool_parameters()
    self.toolchange_flag = True
    yield INTERP_EXECUTE_FINISH


# -------------------------------------------------------------------------------------- S and F: speed, feed

def setspeed_prolog(self, **words):
    """Gives #<speed>."""
    block = _block(self)
    if not block.s_flag:
        return 'S requires a value'
    self.params['speed'] = block.s_number
    return INTERP_OK


def setspeed_epilog(self, **words):
    error = _refusal(self, 'S')
    if error or _block(self).builtin_used:
        return error
    speed = self.params['speed']
    spindle = self.active_spindle
    self.speed[spindle] = speed
    emccanon.enqueue_SET_SPINDLE_SPEED(spindle, speed)
    return INTERP_OK


def setfeed_prolog(self, **words):
    """Gives #<feed>."""
    block = _block(self)
    if not block.f_flag:
        return 'F requires a value'
    self.params['feed'] = block.f_number
    return INTERP_OK


def setfeed_epilog(self, **words):
    error = _refusal(self, 'F')
    if error or _block(self).builtin_used:
        return error
    self.feed_rate = self.params['feed']
    emccanon.enqueue_SET_FEED_RATE(self.feed_rate)
    return INTERP_OK


# ------------------------------------------------------------------------------------------------- cycles

def init_stdglue(self):
    """For __init__ of the top-level script; cycles keep their words between blocks."""
    self.sticky_params = {}


def _cycle_error(self, name, words, sticky):
    """Why these words are not a valid cycle, or None."""
    if any(letter in words for letter in 'abc'):
        return f'{name}: A, B and C cannot be used in a cycle'
    linear = any(letter in sticky for letter in 'xyz')
    extra = any(letter in sticky for letter in 'uvw')
    if linear and extra:
        return f'{name}: XYZ and UVW cannot be used together in a cycle'
    if not linear and not extra:
        return f'{name}: at least one axis word is needed'
    if sticky.get('p', 0.0) < 0.0:
        return f'{name}: P must not be negative'
    if sticky.get('r', 0.0) <= 0.0:
        return f'{name}: R must be given and above 0'
    if sticky['l'] < 1 or sticky['l'] != int(sticky['l']):
        return f'{name}: L must be a whole number above 0'
    if self.feed_rate == 0.0:
        return f'{name}: a feed rate above 0 is needed'
    if self.feed_mode == 1:
        return f'{name}: cannot be used under inverse time feed (G93)'
    if self.cutter_comp_side:
        return f'{name}: cannot be used with cutter radius compensation on'
    return None


def _sticky_words(self, name):
    """The words kept from the last block of this cycle: R and those along the plane's normal."""
    if not hasattr(self, 'sticky_params'):
        init_stdglue(self)
    return self.sticky_params.setdefault(name, {})


def cycle_prolog(self, **words):
    """Sets the words as #<x>, #<y>...; R and the depth are kept between blocks of the same cycle."""
    remap = _block(self).executing_remap
    sticky = _sticky_words(self, remap.name)
    if self.motion_mode != remap.motion_code:
        sticky.clear()  # the first block of the cycle
    normal = {_PLANE_XY: 'zw', _PLANE_YZ: 'xu', _PLANE_XZ: 'yv'}.get(self.plane, 'zw')
    merged = dict(sticky)
    merged.update((word, value) for word, value in words.items() if word in _CYCLE_WORDS)
    merged.setdefault('l', 1)
    error = _cycle_error(self, remap.name, words, merged)
    if error:
        return error
    sticky.update((word, merged[word]) for word in normal + 'r' if word in merged)
    for word, value in merged.items():
        self.params[word] = value
    return INTERP_OK


def cycle_epilog(self, **words):
    """Makes the code modal: a block with only words runs it again."""
    remap = _block(self).executing_remap
    if remap.motion_code >= 0:
        self.motion_mode = remap.motion_code
    return INTERP_OK


# --------------------------------------------------------------------------------------------------- lathes

def index_lathe_tool_with_wear(self, **words):
    """REMAP=T python=index_lathe_tool_with_wear: T201 selects tool 2 and adds the wear offset of entry 10001."""
    block = _block(self)
    if not block.t_flag:
        yield 'T requires a tool number'
    tool, wear = divmod(block.t_number, 100)
    if tool == 0 and block.t_number < 100:
        tool, wear = block.t_number, 0
    pocket, error = (0, None) if tool == 0 else _find_tool(self, tool, f'T{block.t_number}')
    if error:
        yield error
    if wear:
        _, error = _find_tool(self, 10000 + wear, f'T{block.t_number}')
        if error:
            yield error
    self.selected_tool, self.selected_pocket = tool, pocket
    emccanon.SELECT_TOOL(tool)
    emccanon.CHANGE_TOOL(pocket)
    self.current_pocket = pocket
    self.selected_tool, self.selected_pocket = -1, -1
    self.set_tool_parameters()
    self.toolchange_flag = True
    yield INTERP_EXECUTE_FINISH
    self.execute('G43')
    if wear:
        self.execute(f'G43.2 H{10000 + wear}')


def ignore_m6(self, **words):
    """REMAP=M6 python=ignore_m6: lathes change tools with T only."""
    if self.current_tool == 0:
        return 'M6: there is no tool in the spindle; T changes it'
    return INTERP_OK
