// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/codes/code_texts.hh"

#include <algorithm>
#include <array>

namespace mw::gcode {
namespace {

constexpr std::string_view ARC =
    "i=centre, along X|j=centre, along Y|k=centre, along Z|r=radius; negative for more than "
    "half a turn|p=turns, from 1";
constexpr std::string_view THREAD = "k=distance per spindle revolution|$=spindle";
constexpr std::string_view CYCLE = "r=height to which it retracts and from which it feeds|l=repeats";
constexpr std::string_view DWELL_CYCLE =
    "r=height to which it retracts and from which it feeds|l=repeats|p=time to wait at the "
    "bottom [s]";
constexpr std::string_view SPINDLE_CYCLE =
    "r=height to which it retracts and from which it feeds|l=repeats|p=time to wait at the "
    "bottom [s]|$=spindle";
constexpr std::string_view PECK_CYCLE =
    "r=height to which it retracts and from which it feeds|l=repeats|q=depth of one peck|p=way "
    "back between pecks";
constexpr std::string_view PROFILE =
    "q=number of the subroutine with the profile|x=position at the beginning|z=position at the "
    "beginning|d=allowance left on the profile; of G70 the first distance|e=last distance of G70|"
    "i=depth of one cut|r=retract after a cut|p=number of passes";
constexpr std::string_view SPINDLE = "$=spindle; -1 all of them";
constexpr std::string_view ON_OFF = "p=0 off, else on";

constexpr CodeText TEXTS[] = {
    {'g', 0, "rapid move in a straight line", ""},
    {'g', 10, "straight move at the feed rate", ""},
    {'g', 20, "clockwise arc or helix at the feed rate", ARC},
    {'g', 30, "counterclockwise arc or helix at the feed rate", ARC},
    {'g', 40, "dwell: wait", "p=time to wait [s]"},
    {'g', 50, "cubic spline in the plane",
     "i=first control point from the start, along the first axis|j=the same along the second axis|p=second "
     "control "
     "point from the end, along the first axis|q=the same along the second axis"},
    {'g', 51, "quadratic spline in the plane",
     "i=control point from the start, along the first axis|j=the same along the second axis"},
    {'g', 52, "control point of a NURBS in the plane", "p=weight|l=order of the NURBS, on its first line"},
    {'g', 53, "end of a NURBS, which runs now", ""},
    {'g', 70, "diameter mode: X words are diameters", ""},
    {'g', 80, "radius mode: X words are radii", ""},
    {'g', 100, "set offsets, coordinate systems and the tool table",
     "l=1 tool table, 2 coordinate system, 10 and 11 tool table from the position, 20 coordinate system from "
     "the "
     "position|p=tool, or coordinate system from 1, 0 the active one|r=tool radius, or rotation "
     "[deg]|i=front angle of "
     "a lathe tool [deg]|j=back angle of a lathe tool [deg]|q=orientation of a lathe tool, 0 to 9"},
    {'g', 170, "plane XY", ""},
    {'g', 171, "plane UV", ""},
    {'g', 180, "plane XZ", ""},
    {'g', 181, "plane UW", ""},
    {'g', 190, "plane YZ", ""},
    {'g', 191, "plane VW", ""},
    {'g', 200, "inches", ""},
    {'g', 210, "millimetres", ""},
    {'g', 280, "go to the first stored position through the given one", ""},
    {'g', 281, "store the machine's position as the first one (G28)", ""},
    {'g', 300, "go to the second stored position through the given one", ""},
    {'g', 301, "store the machine's position as the second one (G30)", ""},
    {'g', 330, "straight move in step with the spindle", THREAD},
    {'g', 331, "rigid tapping: in step with the spindle, there and back",
     "k=distance per spindle revolution|i=factor of the spindle speed for the retract|$=spindle"},
    {'g', 382, "probe towards the work piece until contact; none is an error", ""},
    {'g', 383, "probe towards the work piece until contact", ""},
    {'g', 384, "probe away from the work piece until contact is lost; none lost is an error", ""},
    {'g', 385, "probe away from the work piece until contact is lost", ""},
    {'g', 400, "cutter compensation off", ""},
    {'g', 410, "cutter compensation left of the path",
     "d=tool whose radius counts; else the one in the spindle"},
    {'g', 411, "cutter compensation left of the path, of a given size",
     "d=diameter|l=orientation of a lathe tool, 0 to 9"},
    {'g', 420, "cutter compensation right of the path",
     "d=tool whose radius counts; else the one in the spindle"},
    {'g', 421, "cutter compensation right of the path, of a given size",
     "d=diameter|l=orientation of a lathe tool, 0 to 9"},
    {'g', 430, "tool offset from the tool table", "h=tool; else the one in the spindle"},
    {'g', 431, "tool offset as given", ""},
    {'g', 432, "one more tool offset on top", "h=tool whose offset is added; else axis words"},
    {'g', 490, "tool offset off", ""},
    {'g', 520, "shift the coordinate system by the amounts given", ""},
    {'g', 530, "this line is in machine coordinates", ""},
    {'g', 540, "coordinate system 1", ""},
    {'g', 550, "coordinate system 2", ""},
    {'g', 560, "coordinate system 3", ""},
    {'g', 570, "coordinate system 4", ""},
    {'g', 580, "coordinate system 5", ""},
    {'g', 590, "coordinate system 6", ""},
    {'g', 591, "coordinate system 7", ""},
    {'g', 592, "coordinate system 8", ""},
    {'g', 593, "coordinate system 9", ""},
    {'g', 610, "exact path: no corner is rounded", ""},
    {'g', 611, "exact stop: stop after each move", ""},
    {'g', 640, "continuous path: corners may be rounded",
     "p=how far the path may leave the programmed one|q=how far points of small moves may be left "
     "out|r=planner: 0 "
     "limited by acceleration, above 0 by jerk, with this part of the corner speed"},
    {'g', 700, "lathe finishing: run along a profile", PROFILE},
    {'g', 710, "lathe roughing with cuts along Z", PROFILE},
    {'g', 711, "lathe roughing with cuts along Z, pockets left out", PROFILE},
    {'g', 712, "lathe roughing with cuts along Z, only what G71.1 has left out", PROFILE},
    {'g', 720, "lathe roughing with cuts along X", PROFILE},
    {'g', 721, "lathe roughing with cuts along X, pockets left out", PROFILE},
    {'g', 722, "lathe roughing with cuts along X, only what G72.1 has left out", PROFILE},
    {'g', 730, "drilling that breaks the chip", PECK_CYCLE},
    {'g', 740, "left-hand tapping with a floating chuck", SPINDLE_CYCLE},
    {'g', 760, "lathe threading in several cuts",
     "p=distance per spindle revolution|i=height of the thread's crest from the drive line|j=depth of the "
     "first cut|k=depth of the "
     "thread|r=how the depth of cuts decreases|q=angle of the compound slide [deg]|h=spring passes|e=length "
     "of the "
     "taper|l=taper: 0 none, 1 entry, 2 exit, 3 both|$=spindle"},
    {'g', 800, "no motion mode: axis words alone are an error", ""},
    {'g', 810, "drilling", CYCLE},
    {'g', 820, "drilling with a dwell at the bottom", DWELL_CYCLE},
    {'g', 830, "deep drilling with full retracts", PECK_CYCLE},
    {'g', 840, "right-hand tapping with a floating chuck", SPINDLE_CYCLE},
    {'g', 850, "boring, out at the feed rate", CYCLE},
    {'g', 860, "boring with a dwell, spindle stop and rapid out", SPINDLE_CYCLE},
    {'g', 870, "back boring",
     "r=height to which it retracts|l=repeats|i=sidestep along X|j=sidestep along Y|k=upper end of the "
     "bore|p=time to "
     "wait at the bottom [s]"},
    {'g', 880, "boring with a dwell, spindle stop and program stop", DWELL_CYCLE},
    {'g', 890, "boring with a dwell, out at the feed rate", DWELL_CYCLE},
    {'g', 900, "absolute distances", ""},
    {'g', 901, "absolute centres of arcs", ""},
    {'g', 910, "incremental distances", ""},
    {'g', 911, "incremental centres of arcs", ""},
    {'g', 920, "offset so that the position is what is given", ""},
    {'g', 921, "forget the G92 offset", ""},
    {'g', 922, "suspend the G92 offset", ""},
    {'g', 923, "restore the suspended G92 offset", ""},
    {'g', 930, "inverse time: F is one over the minutes of the move", ""},
    {'g', 940, "F in units per minute", ""},
    {'g', 950, "F in units per revolution", "$=spindle"},
    {'g', 960, "constant surface speed", "d=maximum spindle speed [rev/min]|$=spindle"},
    {'g', 970, "constant speed of the spindle", "$=spindle"},
    {'g', 980, "cycles retract to where the first one began", ""},
    {'g', 990, "cycles retract to R", ""},
    {'m', 0, "stop until cycle start", ""},
    {'m', 1, "stop if optional stops are on", ""},
    {'m', 2, "end of the program", ""},
    {'m', 3, "spindle on clockwise", SPINDLE},
    {'m', 4, "spindle on counterclockwise", SPINDLE},
    {'m', 5, "spindle off", SPINDLE},
    {'m', 6, "change to the tool that T selected", ""},
    {'m', 7, "mist on", ""},
    {'m', 8, "flood on", ""},
    {'m', 9, "mist and flood off", ""},
    {'m', 19, "orient the spindle",
     "r=angle [deg]|q=longest time for it [s]|p=0 the shorter way, 1 clockwise, 2 "
     "counterclockwise|$=spindle"},
    {'m', 30, "exchange pallets and end the program", ""},
    {'m', 48, "speed and feed overrides on", ""},
    {'m', 49, "speed and feed overrides off", ""},
    {'m', 50, "feed override", ON_OFF},
    {'m', 51, "spindle override", "p=0 off, else on|$=spindle"},
    {'m', 52, "adaptive feed", ON_OFF},
    {'m', 53, "feed stop", ON_OFF},
    {'m', 60, "exchange pallets and stop until cycle start", ""},
    {'m', 61, "set the number of the tool in the spindle", "q=tool"},
    {'m', 62, "digital output on, in step with motion", "p=output"},
    {'m', 63, "digital output off, in step with motion", "p=output"},
    {'m', 64, "digital output on, at once", "p=output"},
    {'m', 65, "digital output off, at once", "p=output"},
    {'m', 66, "wait for an input",
     "p=digital input|e=analog input|l=0 do not wait, 1 rise, 2 fall, 3 high, 4 low|q=longest wait [s]"},
    {'m', 67, "analog output, in step with motion", "e=output|q=value"},
    {'m', 68, "analog output, at once", "e=output|q=value"},
    {'m', 70, "remember the modes", ""},
    {'m', 71, "forget the remembered modes", ""},
    {'m', 72, "restore the remembered modes", ""},
    {'m', 73, "remember the modes until the subroutine ends", ""},
    {'m', 98, "call a subroutine of Fanuc style", "p=its number|l=repeats"},
    {'m', 99, "return from a subroutine of Fanuc style, or begin the program again", ""},
};

}  // namespace

std::span<const CodeText> code_texts() {
    return TEXTS;
}

const CodeText *find_code_text(char letter, int number) {
    const auto found = std::find_if(std::begin(TEXTS), std::end(TEXTS), [&](const CodeText &text) {
        return text.letter == letter && text.number == number;
    });
    return found == std::end(TEXTS) ? nullptr : &*found;
}

std::string_view word_text(const CodeText &code, char letter) {
    std::string_view rest = code.words;
    while (!rest.empty()) {
        const std::size_t end = std::min(rest.find('|'), rest.size());
        if (rest[0] == letter) {
            return rest.substr(2, end - 2);
        }
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    return {};
}

}  // namespace mw::gcode
