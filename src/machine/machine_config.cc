// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/machine_config.hh"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "base/text.hh"
#include "geom/pose.hh"
#include "interp/ini_settings.hh"
#include "machine/inert_keys.hh"
#include "motion/api/parameters.hh"

namespace mw::machine {
namespace {

using config::IniReader;

constexpr double INF = std::numeric_limits<double>::infinity();

void read_names(IniReader &ini, MachineConfig &machine) {
    machine.name = ini.text("EMC", "MACHINE", "machine");
    ini.know_all("EMC",
                 {"VERSION", "DEBUG", "RCS_DEBUG", "RCS_DEBUG_DEST", "RCS_MAX_ERR", "LOG_LEVEL", "NML_FILE"});
    machine.display = ini.text("DISPLAY", "DISPLAY", "");
    ini.know("DISPLAY", "PROGRAM_PREFIX");
    for (const char *section : {"FILTER", "PYTHON", "MDI_COMMAND_LIST"}) {
        ini.leave_open(section);
    }
}

void read_coordinates(IniReader &ini, MachineConfig &machine) {
    const std::string text = ini.required_text("TRAJ", "COORDINATES");
    for (const char c : text) {
        const int axis = geom::axis_of_letter(c);
        if (axis >= 0) {
            machine.coordinates += geom::AXIS_LETTERS[axis];
            machine.axis_mask |= 1U << axis;
        } else if (c != ' ' && c != '\t' && c != ',') {
            ini.sink().error("[TRAJ]COORDINATES = '" + text + "' has the letter '" + c + "'",
                             ini.file().find("TRAJ", "COORDINATES")->place, "expected letters of XYZABCUVW");
            return;
        }
    }
}

void read_kinematics(IniReader &ini, MachineConfig &machine) {
    machine.kinematics = split_words(ini.required_text("KINS", "KINEMATICS"));
    machine.num_joints = static_cast<int>(ini.required_integer("KINS", "JOINTS", 1, MAX_JOINTS));
    std::string letters = machine.coordinates;
    for (const std::string &word : machine.kinematics) {
        if (to_lower(word).substr(0, 12) == "coordinates=") {
            letters = to_upper(word.substr(12));
        }
    }
    machine.axis_map = motion::axis_map(letters, machine.num_joints);
    machine.isTrivial = !machine.kinematics.empty() && machine.kinematics.front() == "trivkins";
    machine.joint_of_axis.fill(-1);
    for (int joint = static_cast<int>(std::min<std::size_t>(letters.size(), MAX_JOINTS)) - 1; joint >= 0;
         --joint) {
        const int axis = geom::axis_of_letter(letters[static_cast<std::size_t>(joint)]);
        if (axis >= 0) {
            machine.joint_of_axis[static_cast<std::size_t>(axis)] = joint;
        }
    }
}

/// One setting of the motion controller from its INI key; nothing when the key is absent.
void read_parameter(IniReader &ini, const std::string &section, const motion::ParameterInfo &info, int index,
                    MachineConfig &machine) {
    if (info.parameter == motion::Parameter::JOINT_IS_ANGULAR) {
        const bool isAngular = ini.choice(section, "TYPE", "LINEAR", {"LINEAR", "ANGULAR"}) == "ANGULAR";
        machine.parameters.push_back({static_cast<std::uint16_t>(info.parameter),
                                      static_cast<std::int16_t>(index), isAngular ? 1.0 : 0.0});
        return;
    }
    ini.know(section, info.ini_key);
    if (ini.file().find(section, info.ini_key) == nullptr) {
        return;
    }
    double value = 0;
    if (info.unit == motion::ParameterUnit::FLAG) {
        value = ini.boolean(section, info.ini_key, info.preset != 0) ? 1.0 : 0.0;
    } else if (info.unit == motion::ParameterUnit::COUNT) {
        value = static_cast<double>(ini.integer(section, info.ini_key, static_cast<std::int64_t>(info.preset),
                                                static_cast<std::int64_t>(info.lowest),
                                                static_cast<std::int64_t>(info.highest)));
    } else {
        value = ini.real(section, info.ini_key, info.preset, {info.lowest, info.highest});
    }
    machine.parameters.push_back(
        {static_cast<std::uint16_t>(info.parameter), static_cast<std::int16_t>(index), value});
}

void read_scope(IniReader &ini, const std::string &section, motion::ParameterScope scope, int index,
                MachineConfig &machine) {
    for (const motion::ParameterInfo &info : motion::PARAMETERS) {
        const bool isElsewhere = info.parameter == motion::Parameter::MAX_FEED_SCALE;
        if (info.scope == scope && !isElsewhere) {
            read_parameter(ini, section, info, index, machine);
        }
    }
}

/// Files of the field leave sections out; what holds then is said.
void miss_section(IniReader &ini, const std::string &section, const std::string &instead) {
    if (!ini.file().hasSection(section)) {
        ini.sink().warning("section [" + section + "] is missing: " + instead, {ini.file().path(), 0, 0});
    }
}

/// Limits that nothing can move between, and a HOME that lies beyond them.
void check_travel(IniReader &ini, const std::string &section, const char *what) {
    const double low = ini.real(section, "MIN_LIMIT", -INF);
    const double high = ini.real(section, "MAX_LIMIT", INF);
    const double home = ini.real(section, "HOME", 0.0);
    if (low == high) {
        ini.sink().warning('[' + section + "]MIN_LIMIT and MAX_LIMIT are equal: the " + what + " cannot move",
                           ini.file().find(section, "MIN_LIMIT")->place);
    }
    const config::IniEntry *entry = ini.file().find(section, "HOME");
    if (entry != nullptr && low <= high && (home < low || home > high)) {
        ini.sink().warning('[' + section + "]HOME = " + entry->value +
                               " is outside of MIN_LIMIT and MAX_LIMIT",
                           entry->place);
    }
}

/// Keys that exist in the field and that this version does not act on: said once, never ignored in silence.
void warn_without_effect(IniReader &ini, const std::string &section,
                         std::initializer_list<const char *> keys) {
    for (const char *key : keys) {
        const config::IniEntry *entry = ini.file().find(section, key);
        if (entry != nullptr) {
            ini.sink().warning('[' + section + ']' + key +
                                   " is not supported by this version; it has no effect",
                               entry->place);
        }
    }
}

/// A joint section beyond the last joint is one with a wrong number, so one that is missing is no choice.
bool hasJointBeyond(const IniReader &ini, int num_joints) {
    for (const std::string &section : ini.file().sections()) {
        const auto number = section.starts_with("JOINT_") ? parse_int(section.substr(6)) : std::nullopt;
        if (number.has_value() && *number >= num_joints) {
            return true;
        }
    }
    return false;
}

void miss_joint(IniReader &ini, const std::string &section, int num_joints) {
    if (!ini.file().hasSection(section) && hasJointBeyond(ini, num_joints)) {
        ini.sink().error("section [" + section + "] is missing, and one stands beyond [KINS]JOINTS",
                         {ini.file().path(), 0, 0}, "joints are numbered from 0");
    } else {
        miss_section(ini, section, "the joint is linear and has no limits, with 1 unit/s and 1 unit/s2");
    }
}

void read_joints(IniReader &ini, MachineConfig &machine) {
    for (int joint = 0; joint < machine.num_joints; ++joint) {
        const std::string section = "JOINT_" + std::to_string(joint);
        miss_joint(ini, section, machine.num_joints);
        check_travel(ini, section, "joint");
        read_scope(ini, section, motion::ParameterScope::JOINT, joint, machine);
        for (const char *key : {"MAX_VELOCITY", "MAX_ACCELERATION"}) {
            const bool isMissing = ini.file().hasSection(section) && ini.file().find(section, key) == nullptr;
            const bool isZero =
                !isMissing && ini.file().hasSection(section) && ini.real(section, key, 1.0) <= 0.0;
            if (isMissing) {
                ini.sink().warning('[' + section + ']' + key + " is missing; 1 unit is used",
                                   ini.file().place_of_section(section));
            } else if (isZero) {
                ini.sink().error('[' + section + ']' + key + " must be above 0",
                                 ini.file().find(section, key)->place);
            }
        }
        ini.know_all(section, {"UNITS",
                               "COMP_FILE",
                               "COMP_FILE_TYPE",
                               "LOCKING_INDEXER",
                               "INPUT_SCALE",
                               "OUTPUT_SCALE",
                               "ENCODER_SCALE",
                               "SCALE",
                               "P",
                               "I",
                               "D",
                               "FF0",
                               "FF1",
                               "FF2",
                               "BIAS",
                               "DEADBAND",
                               "MAX_OUTPUT",
                               "OUTPUT_OFFSET",
                               "DIRSETUP",
                               "DIRHOLD",
                               "STEPLEN",
                               "STEPSPACE",
                               "STEPGEN_MAXVEL",
                               "STEPGEN_MAXACCEL"});
        warn_without_effect(ini, section, {"COMP_FILE", "LOCKING_INDEXER"});
    }
}

/// [TRAJ]MAX_ANGULAR_VELOCITY and MAX_ANGULAR_ACCELERATION hold for each axis of rotation.
void limit_angular(IniReader &ini, int axis, MachineConfig &machine) {
    const motion::FoldedLimits limits = machine.limits();
    const auto limit = [&](const char *key, motion::Parameter parameter, const traj::PerLimited &present) {
        const double most = ini.real("TRAJ", key, INF, {0.0, INF});
        if (most < present[static_cast<std::size_t>(axis)]) {
            machine.parameters.push_back(
                {static_cast<std::uint16_t>(parameter), static_cast<std::int16_t>(axis), most});
        }
    };
    limit("MAX_ANGULAR_VELOCITY", motion::Parameter::AXIS_MAX_VELOCITY, limits.path.velocity);
    limit("MAX_ANGULAR_ACCELERATION", motion::Parameter::AXIS_MAX_ACCELERATION, limits.path.acceleration);
}

void read_axes(IniReader &ini, MachineConfig &machine) {
    for (int axis = 0; axis < MAX_AXES; ++axis) {
        if ((machine.axis_mask & (1U << axis)) == 0) {
            continue;
        }
        const std::string section = std::string("AXIS_") + geom::AXIS_LETTERS[axis];
        miss_section(ini, section, "the axis has the limits of its joint");
        check_travel(ini, section, "axis");
        if (ini.real(section, "MIN_LIMIT", -INF) > ini.real(section, "MAX_LIMIT", INF)) {
            ini.sink().error('[' + section + "]MIN_LIMIT is above MAX_LIMIT",
                             ini.file().find(section, "MIN_LIMIT")->place);
        }
        read_scope(ini, section, motion::ParameterScope::AXIS, axis, machine);
        if (geom::isAngular(axis)) {
            limit_angular(ini, axis, machine);
        }
        ini.know_all(section,
                     {"HOME", "WRAPPED_ROTARY", "LOCKING_INDEXER_JOINT", "OFFSET_AV_RATIO", "GEOMETRY"});
        warn_without_effect(ini, section, {"WRAPPED_ROTARY", "LOCKING_INDEXER_JOINT", "OFFSET_AV_RATIO"});
    }
}

/// A number says how many units a millimetre has.
bool read_isMetric(IniReader &ini) {
    const config::IniEntry *entry = ini.file().find("TRAJ", "LINEAR_UNITS");
    const auto per_mm = entry == nullptr ? std::nullopt : parse_double(entry->value);
    constexpr double INCHES_PER_MM = 1.0 / 25.4;
    if (per_mm.has_value() && (*per_mm == 1.0 || std::fabs(*per_mm - INCHES_PER_MM) < 1e-6)) {
        ini.know("TRAJ", "LINEAR_UNITS");
        ini.sink().warning("[TRAJ]LINEAR_UNITS = " + entry->value + " is taken as " +
                               (*per_mm == 1.0 ? "mm" : "inch"),
                           entry->place);
        return *per_mm == 1.0;
    }
    const std::string units =
        ini.choice("TRAJ", "LINEAR_UNITS", "mm", {"mm", "inch", "in", "imperial", "metric"});
    return units == "mm" || units == "metric";
}

void read_trajectory(IniReader &ini, MachineConfig &machine) {
    machine.isMetric = read_isMetric(ini);
    // 1.0: a number of degrees, as files of the field have it.
    ini.choice("TRAJ", "ANGULAR_UNITS", "degree", {"degree", "degrees", "deg", "1.0", "1"});
    read_scope(ini, "TRAJ", motion::ParameterScope::MACHINE, 0, machine);
    const auto highest_scale = static_cast<std::uint16_t>(motion::Parameter::MAX_FEED_SCALE);
    machine.parameters.push_back(
        {highest_scale, 0, ini.real("DISPLAY", "MAX_FEED_OVERRIDE", 1.0, {0.0, 1000.0})});
    machine.num_spindles = static_cast<int>(ini.integer("TRAJ", "SPINDLES", 1, 1, MAX_SPINDLES));
    for (int spindle = 0; spindle < machine.num_spindles; ++spindle) {
        const std::string section = "SPINDLE_" + std::to_string(spindle);
        read_scope(ini, section, motion::ParameterScope::SPINDLE, spindle, machine);
        ini.know_all(section, {"HOME_SEARCH_VELOCITY", "HOME_SEQUENCE", "INCREMENT"});
    }
    ini.know_all("TRAJ", {"AXES",
                          "CYCLE_TIME",
                          "DEFAULT_LINEAR_VELOCITY",
                          "DEFAULT_LINEAR_ACCELERATION",
                          "MAX_ANGULAR_VELOCITY",
                          "DEFAULT_ANGULAR_VELOCITY",
                          "DEFAULT_ANGULAR_ACCELERATION",
                          "MAX_ANGULAR_ACCELERATION",
                          "DEFAULT_VELOCITY",
                          "MAX_VELOCITY",
                          "DEFAULT_ACCELERATION",
                          "MAX_ACCELERATION",
                          "POSITION_FILE",
                          "HOME",
                          "TPMOD",
                          "NO_PROBE_JOG_ERROR",
                          "NO_PROBE_HOME_ERROR",
                          "ARC_BLEND_ENABLE",
                          "ARC_BLEND_FALLBACK_ENABLE",
                          "ARC_BLEND_OPTIMIZATION_DEPTH",
                          "ARC_BLEND_GAP_CYCLES",
                          "ARC_BLEND_RAMP_FREQ",
                          "ARC_BLEND_KINK_RATIO"});
    machine.task.sequencer.smooth_planner = static_cast<int>(ini.integer("TRAJ", "SMOOTH_PLANNER", 1, 0, 1));
}

void read_periods(IniReader &ini, MachineConfig &machine) {
    machine.servo_period_ns = ini.integer("EMCMOT", "SERVO_PERIOD", 1000000, 10000, 100000000);
    ini.know_all("EMCMOT", {"EMCMOT", "HOMEMOD", "BASE_PERIOD", "TRAJ_PERIOD", "COMM_TIMEOUT", "COMM_WAIT",
                            "SHMEM_KEY"});
    const double cycle_s = ini.real("TASK", "CYCLE_TIME", 0.001, {0.0001, 1.0});
    // A slow task cycle must not look like one that stands still.
    machine.task.watchdog_s = std::max(0.5, 10.0 * cycle_s);
    machine.task_period_ns = static_cast<std::int64_t>(std::llround(cycle_s * 1e9));
    machine.task.interpreter_plugin = ini.text("TASK", "INTERPRETER", "");
    ini.know_all("TASK", {"TASK", "MDI_QUEUED_COMMANDS"});
}

void read_hal(IniReader &ini, MachineConfig &machine) {
    const auto files = ini.list("HAL", "HALFILE");
    if (files.empty()) {
        ini.required_text("HAL", "HALFILE");
    }
    for (const config::IniEntry *entry : files) {
        machine.hal_steps.push_back({HalStep::Kind::FILE, entry->value, entry->place});
    }
    for (const config::IniEntry *entry : ini.list("HAL", "HALCMD")) {
        machine.hal_steps.push_back({HalStep::Kind::COMMAND, entry->value, entry->place});
    }
    machine.two_pass = ini.text("HAL", "TWOPASS", "");
    machine.hasHalui = !ini.text("HAL", "HALUI", "").empty();
    warn_without_effect(ini, "HAL", {"SHUTDOWN"});
    ini.know_all("HAL", {"POSTGUI_HALFILE", "POSTGUI_HALCMD", "SHUTDOWN"});
    ini.list("HALUI", "MDI_COMMAND");
}

void read_interpreter(IniReader &ini, MachineConfig &machine) {
    const std::string parameters = ini.text("RS274NGC", "PARAMETER_FILE", "");
    machine.task.parameter_file = parameters.empty() ? "" : ini.file().resolve_path(parameters);
    std::error_code error;
    if (!parameters.empty() && std::filesystem::file_size(machine.task.parameter_file, error) == 0 &&
        !error) {
        ini.sink().warning("the parameter file '" + machine.task.parameter_file +
                               "' is empty: all offsets and parameters begin at 0",
                           ini.file().find("RS274NGC", "PARAMETER_FILE")->place);
    }
    if (parameters.empty()) {
        ini.sink().warning(
            "[RS274NGC]PARAMETER_FILE is missing: offsets and parameters are not kept after a run",
            ini.file().place_of_section("RS274NGC"));
    }
    machine.task.interpreter = interp::settings_from_ini(ini.file(), ini.sink());
    const auto fastest = static_cast<std::uint16_t>(motion::Parameter::TRAJ_MAX_VELOCITY);
    for (const motion::SetParameter &parameter : machine.parameters) {
        if (parameter.parameter == fastest && std::isfinite(parameter.value)) {
            constexpr double MM_PER_INCH = 25.4;
            machine.task.interpreter.max_velocity_mm_s =
                parameter.value * (machine.isMetric ? 1.0 : MM_PER_INCH);
        }
    }
    machine.task.interpreter.isLathe = ini.boolean("DISPLAY", "LATHE", false);
    ini.know_all("RS274NGC", {"RS274NGC_STARTUP_CODE",
                              "DISABLE_G92_PERSISTENCE",
                              "DISABLE_FANUC_STYLE_SUB",
                              "KEEP_COORDINATE_SYSTEM",
                              "REMAP",
                              "CENTER_ARC_RADIUS_TOLERANCE_MM",
                              "CENTER_ARC_RADIUS_TOLERANCE_INCH",
                              "ORIENT_OFFSET",
                              "SUBROUTINE_PATH",
                              "USER_M_PATH",
                              "LOG_LEVEL",
                              "LOG_FILE",
                              "INI_VARS",
                              "HAL_PIN_VARS",
                              "FEATURES",
                              "ON_ABORT_COMMAND",
                              "OWORD_NARGS",
                              "OWORD_WARNONLY",
                              "NO_DOWNCASE_OWORD",
                              "RETAIN_G43",
                              "PARAMETER_G73_PECK_CLEARANCE",
                              "PARAMETER_G83_PECK_CLEARANCE"});
}

void read_io(IniReader &ini, MachineConfig &machine) {
    const std::string table = ini.text("EMCIO", "TOOL_TABLE", "");
    machine.tool_table_file = table.empty() ? "" : ini.file().resolve_path(table);
    machine.isRandomToolchanger = ini.boolean("EMCIO", "RANDOM_TOOLCHANGER", false);
    if (machine.isRandomToolchanger) {
        ini.sink().error("[EMCIO]RANDOM_TOOLCHANGER = 1 is not supported by this version",
                         ini.file().find("EMCIO", "RANDOM_TOOLCHANGER")->place);
    }
    machine.task.sequencer.isToolChangeWithSpindleOn =
        ini.boolean("EMCIO", "TOOL_CHANGE_WITH_SPINDLE_ON", false);
    task::ToolChangePlace &place = machine.task.tool_change_place;
    place.isQuillRaised = ini.boolean("EMCIO", "TOOL_CHANGE_QUILL_UP", false);
    const config::IniEntry *position = ini.file().find("EMCIO", "TOOL_CHANGE_POSITION");
    if (position != nullptr) {
        const std::vector<std::string> words = split_words(position->value);
        for (std::size_t i = 0; i < words.size() && i < MAX_AXES; ++i) {
            const auto value = parse_double(words[i]);
            place.position[static_cast<int>(i)] = value.value_or(0.0);
            place.coordinates = value.has_value() ? place.coordinates + 1 : -1000;
        }
        if (words.size() != 3 && words.size() != 6 && words.size() != 9) {
            place.coordinates = -1;
        }
        if (place.coordinates < 0) {
            ini.sink().error("[EMCIO]TOOL_CHANGE_POSITION = '" + position->value + "' is malformed",
                             position->place, "expected 3, 6 or 9 numbers: X Y Z [A B C [U V W]]");
            place.coordinates = 0;
        }
    }
    ini.know_all("EMCIO", {"EMCIO", "CYCLE_TIME", "TOOL_CHANGE_POSITION", "TOOL_CHANGE_QUILL_UP",
                           "TOOL_CHANGE_AT_G30", "DB_PROGRAM"});
    warn_without_effect(ini, "EMCIO", {"TOOL_CHANGE_AT_G30", "DB_PROGRAM"});
}

}  // namespace

motion::FoldedLimits MachineConfig::limits() const {
    motion::AxisMap map = axis_map;
    map.kind = isTrivial ? motion::AxisMap::Kind::JOINTS_ARE_AXES : motion::AxisMap::Kind::PLANNED;
    return motion::fold_limits(motion::settings_of(parameters), map, motion::ALL_HOMED);
}

MachineConfig read_machine_config(config::IniReader &reader) {
    MachineConfig machine;
    read_names(reader, machine);
    read_coordinates(reader, machine);
    read_kinematics(reader, machine);
    read_trajectory(reader, machine);
    read_joints(reader, machine);
    read_axes(reader, machine);
    read_periods(reader, machine);
    read_hal(reader, machine);
    read_interpreter(reader, machine);
    read_io(reader, machine);
    know_inert_keys(reader);
    machine.task.machine_units = machine.isMetric ? interp::LengthUnits::MM : interp::LengthUnits::INCH;
    machine.task.axis_mask = machine.axis_mask;
    machine.task.num_joints = machine.num_joints;
    machine.task.num_spindles = machine.num_spindles;
    machine.task.isHomingForced = !reader.boolean("TRAJ", "NO_FORCE_HOMING", false);
    return machine;
}

}  // namespace mw::machine
