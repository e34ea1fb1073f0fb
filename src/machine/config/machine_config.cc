// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/config/machine_config.hh"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>

#include "base/duration.hh"
#include "base/geometry/pose.hh"
#include "base/text.hh"
#include "gcode/interpreter/ini_keys.hh"
#include "gcode/interpreter/ini_settings.hh"
#include "machine/config/ini_form.hh"
#include "machine/config/ini_keys.hh"
#include "machine/config/io_config.hh"
#include "machine/config/offset_axes.hh"
#include "machine/config/spindle_config.hh"
#include "motion/interface/parameters.hh"
#include "motion/interface/screw_file.hh"

namespace mw::machine {
namespace {

using ini::IniKey;
using ini::IniKind;
using ini::IniReader;
using motion::Parameter;

/// Tolerance at corners until a program sets G64: LinuxCNC's 0.001 inch.
constexpr double START_TOLERANCE_MM = 0.0254;
constexpr double INF = std::numeric_limits<double>::infinity();

void read_names(IniReader &ini, MachineConfig &machine) {
    machine.name = ini.text(ini_key("EMC", "MACHINE"));
    machine.display = ini.text(ini_key("DISPLAY", "DISPLAY"));
    for (const char *section : {"FILTER", "PYTHON", "MDI_COMMAND_LIST"}) {
        ini.leave_open(section);
    }
}

void read_coordinates(IniReader &ini, MachineConfig &machine) {
    const ini::IniKey &key = ini_key("TRAJ", "COORDINATES");
    const std::string text = ini.text(key);
    for (const char c : text) {
        const int axis = geometry::axis_of_letter(c);
        if (axis >= 0) {
            machine.coordinates += geometry::AXIS_LETTERS[axis];
            machine.axis_mask |= 1U << axis;
        } else if (c != ' ' && c != '\t' && c != ',') {
            ini.sink().error("[TRAJ]COORDINATES = '" + text + "' has the letter '" + c + "'",
                             ini.find(key)->place, "expected letters of XYZABCUVW");
            return;
        }
    }
}

/// Reads [TRAJ]HOME: a number for each letter of COORDINATES.
void read_first_place(IniReader &ini, MachineConfig &machine) {
    const ini::IniKey &key = ini_key("TRAJ", "HOME");
    const std::vector<std::string> words = split_words(ini.text(key));
    std::size_t n = 0;
    for (const std::string &word : words) {
        const std::optional<double> value = parse_double(word);
        if (!value.has_value()) {
            ini.sink().error("[TRAJ]HOME = '" + ini.text(key) + "' has the word '" + word + "'",
                             ini.find(key)->place, "expected numbers, one for each axis");
            return;
        }
        if (n < machine.coordinates.size()) {
            const int axis = geometry::axis_of_letter(machine.coordinates[n]);
            machine.parameters.push_back({static_cast<std::uint16_t>(Parameter::AXIS_FIRST_PLACE),
                                          static_cast<std::int16_t>(axis), *value});
        }
        ++n;
    }
}

/// Number of extra joints on the loadrt line of motmod.
int count_extra_joints(IniReader &ini, int num_joints) {
    const IniKey &key = ini_key("EMCMOT", "EMCMOT");
    const ini::IniEntry *entry = ini.find(key);
    for (const std::string &word : split_words(entry != nullptr ? entry->value : std::string())) {
        constexpr std::string_view NAME = "num_extrajoints=";
        if (!word.starts_with(NAME)) {
            continue;
        }
        const auto count = parse_int(word.substr(NAME.size()));
        if (count.has_value() && *count >= 0 && *count < num_joints) {
            return static_cast<int>(*count);
        }
        ini.sink().error("[EMCMOT]EMCMOT: " + word + " is not possible", entry->place,
                         "0 to [KINS]JOINTS - 1; the extra joints are the last joints");
    }
    return 0;
}

void read_kinematics(IniReader &ini, MachineConfig &machine) {
    machine.kinematics = split_words(ini.text(ini_key("KINS", "KINEMATICS")));
    machine.num_joints = static_cast<int>(ini.integer(ini_key("KINS", "JOINTS")));
    std::string letters = machine.coordinates;
    for (const std::string &word : machine.kinematics) {
        if (to_lower(word).substr(0, 12) == "coordinates=") {
            letters = to_upper(word.substr(12));
        }
    }
    machine.axis_map = motion::axis_map(letters, machine.num_joints);
    machine.axis_map.num_extra = count_extra_joints(ini, machine.num_joints);
    machine.isTrivial = !machine.kinematics.empty() && machine.kinematics.front() == "trivkins";
    machine.axis_map.set_linear(linear_joints(machine.kinematics));
    machine.joint_of_axis.fill(-1);
    for (int joint = static_cast<int>(std::min<std::size_t>(letters.size(), MAX_JOINTS)) - 1; joint >= 0;
         --joint) {
        const int axis = geometry::axis_of_letter(letters[static_cast<std::size_t>(joint)]);
        if (axis >= 0) {
            machine.joint_of_axis[static_cast<std::size_t>(axis)] = joint;
        }
    }
}

/// Reads a setting of the motion controller from its INI key, if the key is set or has no other source.
void read_parameter(IniReader &ini, const std::string &section, const IniKey &key,
                    motion::SetParameter parameter, MachineConfig &machine) {
    if (key.kind != IniKind::CHOICE && ini.find(key, section) == nullptr) {
        return;
    }
    switch (key.kind) {
    case IniKind::CHOICE: parameter.value = ini.choice(key, section) == key.text ? 0.0 : 1.0; break;
    case IniKind::FLAG: parameter.value = ini.boolean(key, section) ? 1.0 : 0.0; break;
    case IniKind::WHOLE: parameter.value = static_cast<double>(ini.integer(key, section)); break;
    case IniKind::NUMBER: parameter.value = ini.real(key, section); break;
    case IniKind::TEXT:
    case IniKind::LIST: return;
    }
    machine.parameters.push_back(parameter);
}

/// All settings of one section; `pattern` is its name in the declarations.
void read_parameters(IniReader &ini, const std::string &section, std::string_view pattern, int index,
                     MachineConfig &machine) {
    for (const motion::ParameterInfo &info : motion::PARAMETERS) {
        if (info.ini_section == pattern) {
            read_parameter(
                ini, section, ini_key(info.parameter),
                {static_cast<std::uint16_t>(info.parameter), static_cast<std::int16_t>(index), 0.0}, machine);
        }
    }
}

/// INI files for LinuxCNC may omit sections; reports the defaults used instead.
void miss_section(IniReader &ini, const std::string &section, const std::string &instead) {
    if (!ini.file().hasSection(section)) {
        ini.sink().warning("section [" + section + "] is missing: " + instead, {ini.file().path(), 0, 0});
    }
}

/// Declarations of keys that joints and axes share.
struct TravelKeys {
    IniKey low, high, home;
};

/// Reports limits without travel between them, and a HOME outside the limits.
void check_travel(IniReader &ini, const std::string &section, const TravelKeys &keys, const char *what) {
    const double low = ini.real(keys.low, section, -INF);
    const double high = ini.real(keys.high, section, INF);
    const double home = ini.real(keys.home, section);
    if (low == high) {
        ini.sink().warning('[' + section + "]MIN_LIMIT and MAX_LIMIT are equal: the " + what + " cannot move",
                           ini.find(keys.low, section)->place);
    }
    const ini::IniEntry *entry = ini.find(keys.home, section);
    if (entry != nullptr && low <= high && (home < low || home > high)) {
        ini.sink().warning('[' + section + "]HOME = " + entry->value +
                               " is outside of MIN_LIMIT and MAX_LIMIT",
                           entry->place);
    }
}

/// True if there is a section above the last joint. Its number is wrong, so a missing section is an error.
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
        ini.sink().error("section [" + section + "] is missing, but a section above [KINS]JOINTS exists",
                         {ini.file().path(), 0, 0}, "joints are numbered from 0");
    } else {
        miss_section(ini, section, "the joint is linear, without soft limits, with 1 unit/s and 1 unit/s2");
    }
}

/// Checks a speed or acceleration that the joint needs to move.
void check_rate(IniReader &ini, const std::string &section, const IniKey &key) {
    if (!ini.file().hasSection(section)) {
        return;
    }
    const ini::IniEntry *entry = ini.find(key, section);
    const std::string name = '[' + section + ']' + std::string(key.name);
    if (entry == nullptr) {
        ini.sink().warning(name + " is missing; 1 unit is used", ini.file().place_of_section(section));
    } else if (ini.real(key, section) <= 0.0) {
        ini.sink().error(name + " must be above 0", entry->place);
    }
}

/// Reads the table of a joint's screw errors, if the file names one.
void read_compensation(IniReader &ini, const std::string &section, int joint, MachineConfig &machine) {
    const std::string name = ini.text(ini_key("JOINT_*", "COMP_FILE"), section);
    const std::int64_t type = ini.integer(ini_key("JOINT_*", "COMP_FILE_TYPE"), section);
    if (name.empty()) {
        return;
    }
    const ini::IniEntry *entry = ini.find(ini_key("JOINT_*", "COMP_FILE"), section);
    if (ini.find(ini_key("JOINT_*", "COMP_FILE_TYPE"), section) == nullptr) {
        ini.sink().warning('[' + section +
                               "]COMP_FILE_TYPE is missing: 0 is used (nominal and measured positions)",
                           entry->place);
    }
    auto points = motion::read_screw_file(ini.file().resolve_path(name), joint,
                                          static_cast<motion::ScrewFileType>(type));
    if (!points.has_value()) {
        ini.sink().error(points.error());
        return;
    }
    machine.screw_tables.push_back(std::move(*points));
}

void read_joints(IniReader &ini, MachineConfig &machine) {
    const TravelKeys travel = {ini_key(Parameter::JOINT_MIN_LIMIT), ini_key(Parameter::JOINT_MAX_LIMIT),
                               ini_key(Parameter::JOINT_HOME)};
    for (int joint = 0; joint < machine.num_joints; ++joint) {
        const std::string section = "JOINT_" + std::to_string(joint);
        miss_joint(ini, section, machine.num_joints);
        check_travel(ini, section, travel, "joint");
        read_parameters(ini, section, "JOINT_*", joint, machine);
        check_rate(ini, section, ini_key(Parameter::JOINT_MAX_VELOCITY));
        check_rate(ini, section, ini_key(Parameter::JOINT_MAX_ACCELERATION));
        read_compensation(ini, section, joint, machine);
        ini.declare_in(section, "JOINT_*", all_ini_keys());
    }
}

/// [TRAJ]MAX_ANGULAR_VELOCITY and MAX_ANGULAR_ACCELERATION apply to each rotary axis.
void limit_angular(IniReader &ini, int axis, MachineConfig &machine) {
    const motion::FoldedLimits limits = machine.limits();
    const auto limit = [&](const IniKey &key, Parameter parameter, const trajectory::PerLimited &present) {
        const double most = ini.real(key);
        if (most < present[static_cast<std::size_t>(axis)]) {
            machine.parameters.push_back(
                {static_cast<std::uint16_t>(parameter), static_cast<std::int16_t>(axis), most});
        }
    };
    limit(ini_key("TRAJ", "MAX_ANGULAR_VELOCITY"), Parameter::AXIS_MAX_VELOCITY, limits.path.velocity);
    limit(ini_key("TRAJ", "MAX_ANGULAR_ACCELERATION"), Parameter::AXIS_MAX_ACCELERATION,
          limits.path.acceleration);
}

/// Reports a limit of a wrapped axis, because the axis rotates without limit in programs and would reach it.
void check_wrapped(IniReader &ini, const std::string &section, int axis, const TravelKeys &travel) {
    const IniKey &key = gcode::ini_key("AXIS_*", "WRAPPED_ROTARY");
    if (!ini.boolean(key, section)) {
        return;
    }
    if (!geometry::isAngular(axis)) {
        ini.sink().warning('[' + section + "]WRAPPED_ROTARY has no effect: only A, B and C are rotary axes",
                           ini.find(key, section)->place);
        return;
    }
    constexpr double ENDLESS = 1e9;
    const bool bounded =
        ini.real(travel.low, section, -INF) > -ENDLESS || ini.real(travel.high, section, INF) < ENDLESS;
    if (bounded) {
        ini.sink().warning('[' + section +
                               "]WRAPPED_ROTARY: MIN_LIMIT and MAX_LIMIT still limit the axis; delete them",
                           ini.find(key, section)->place);
    }
}

/// Bits of unlock_joints_mask= of motmod, from the loadrt line in the HAL files.
std::uint32_t unlock_mask(const IniReader &ini) {
    const ini::IniEntry *entry = ini.find(ini_key("EMCMOT", "EMCMOT"));
    for (const std::string &word : split_words(entry != nullptr ? entry->value : std::string())) {
        constexpr std::string_view NAME = "unlock_joints_mask=";
        if (word.starts_with(NAME)) {
            return static_cast<std::uint32_t>(std::strtoul(word.c_str() + NAME.size(), nullptr, 0));
        }
    }
    return 0;
}

/// The joint that a program unlocks for G0 of the axis, and settings that conflict with it.
void read_indexer(IniReader &ini, const std::string &section, int axis, MachineConfig &machine) {
    const IniKey &key = gcode::ini_key("AXIS_*", "LOCKING_INDEXER_JOINT");
    const int joint = static_cast<int>(ini.integer(key, section));
    const ini::IniEntry *entry = ini.find(key, section);
    if (joint < 0 || entry == nullptr) {
        return;
    }
    const std::string name = '[' + section + "]LOCKING_INDEXER_JOINT = " + entry->value;
    if (!geometry::isAngular(axis)) {
        ini.sink().warning(name + " has no effect: only A, B and C have indexers", entry->place);
        return;
    }
    const bool other = machine.isTrivial && !machine.axis_map.moves(joint, axis);
    if (joint >= machine.num_joints || other) {
        ini.sink().error(name + ": that joint does not move the axis", entry->place,
                         "the joint of the axis, by the letters of coordinates=");
        return;
    }
    if ((unlock_mask(ini) >> joint & 1U) == 0) {
        ini.sink().warning(name + ": unlock_joints_mask= in [EMCMOT]EMCMOT does not have joint " +
                               entry->value + "; without its pins the axis never unlocks",
                           entry->place);
    }
    if (ini.real(ini_key(Parameter::AXIS_OFFSET_RATIO), section) > 0) {
        ini.sink().warning('[' + section + "]OFFSET_AV_RATIO has no effect on a locking indexer",
                           ini.find(ini_key(Parameter::AXIS_OFFSET_RATIO), section)->place);
    }
    machine.parameters.push_back({static_cast<std::uint16_t>(Parameter::AXIS_LOCKING_INDEXER_JOINT),
                                  static_cast<std::int16_t>(axis), static_cast<double>(joint)});
}

void read_axes(IniReader &ini, MachineConfig &machine) {
    const TravelKeys travel = {ini_key(Parameter::AXIS_MIN_LIMIT), ini_key(Parameter::AXIS_MAX_LIMIT),
                               ini_key("AXIS_*", "HOME")};
    for (int axis = 0; axis < MAX_AXES; ++axis) {
        if ((machine.axis_mask & (1U << axis)) == 0) {
            continue;
        }
        const std::string section = std::string("AXIS_") + geometry::AXIS_LETTERS[axis];
        miss_section(ini, section, "the axis has the limits of its joint");
        check_travel(ini, section, travel, "axis");
        if (ini.real(travel.low, section, -INF) > ini.real(travel.high, section, INF)) {
            ini.sink().error('[' + section + "]MIN_LIMIT is above MAX_LIMIT",
                             ini.find(travel.low, section)->place);
        }
        read_parameters(ini, section, "AXIS_*", axis, machine);
        check_offset(ini, section, axis, machine);
        if (geometry::isAngular(axis)) {
            limit_angular(ini, axis, machine);
        }
        check_wrapped(ini, section, axis, travel);
        read_indexer(ini, section, axis, machine);
        ini.declare_in(section, "AXIS_*", all_ini_keys());
    }
}

/// A number of [TRAJ]LINEAR_UNITS is the number of units per millimetre.
bool read_isMetric(IniReader &ini) {
    const IniKey &key = ini_key("TRAJ", "LINEAR_UNITS");
    const ini::IniEntry *entry = ini.find(key);
    const auto per_mm = entry == nullptr ? std::nullopt : parse_double(entry->value);
    constexpr double INCHES_PER_MM = 1.0 / 25.4;
    if (per_mm.has_value() && (*per_mm == 1.0 || std::fabs(*per_mm - INCHES_PER_MM) < 1e-6)) {
        ini.sink().warning("[TRAJ]LINEAR_UNITS = " + entry->value + " is interpreted as " +
                               (*per_mm == 1.0 ? "mm" : "inch"),
                           entry->place);
        return *per_mm == 1.0;
    }
    const std::string units = ini.choice(key);
    return units == "mm" || units == "metric";
}

void read_trajectory(IniReader &ini, MachineConfig &machine) {
    machine.metric = read_isMetric(ini);
    ini.choice(ini_key("TRAJ", "ANGULAR_UNITS"));
    read_parameters(ini, "TRAJ", "TRAJ", 0, machine);
    read_parameters(ini, "DISPLAY", "DISPLAY", 0, machine);
    machine.num_spindles = static_cast<int>(ini.integer(ini_key("TRAJ", "SPINDLES")));
    for (int spindle = 0; spindle < machine.num_spindles; ++spindle) {
        const std::string section = "SPINDLE_" + std::to_string(spindle);
        ini.declare_in(section, "SPINDLE_*", all_ini_keys());
        read_parameters(ini, section, "SPINDLE_*", spindle, machine);
        read_spindle_limits(ini, spindle, machine);
    }
    machine.task.sequencer.smooth_planner = static_cast<int>(ini.integer(ini_key("TRAJ", "SMOOTH_PLANNER")));
}

void read_periods(IniReader &ini, MachineConfig &machine) {
    machine.servo_period_ns = ini.integer(ini_key("EMCMOT", "SERVO_PERIOD"));
    const double cycle_s = ini.real(ini_key("TASK", "CYCLE_TIME"));
    // The minimum prevents that a slow task cycle is treated as a hang.
    machine.task.watchdog_s = std::max(0.5, 10.0 * cycle_s);
    machine.task_period_ns = to_ns(cycle_s);
    machine.task.mdi_queued_commands = static_cast<int>(ini.integer(ini_key("TASK", "MDI_QUEUED_COMMANDS")));
    machine.task.interpreter_plugin = ini.text(ini_key("TASK", "INTERPRETER"));
}

void read_hal(IniReader &ini, MachineConfig &machine) {
    const auto read_module = [&](const IniKey &key, const char *ours, HalStep &module) {
        const std::vector<std::string> words = split_words(ini.text(key));
        if (!words.empty() && words[0] != ours) {
            module = {HalStep::Kind::COMMAND, ini.text(key), ini.find(key)->place};
        }
    };
    read_module(ini_key("EMCMOT", "HOMEMOD"), "homemod", machine.homing_module);
    read_module(ini_key("TRAJ", "TPMOD"), "tpmod", machine.planner_module);
    for (const ini::IniEntry *entry : ini.list(ini_key("HAL", "HALFILE"))) {
        machine.hal_steps.push_back({HalStep::Kind::FILE, entry->value, entry->place});
    }
    for (const ini::IniEntry *entry : ini.list(ini_key("HAL", "HALCMD"))) {
        machine.hal_steps.push_back({HalStep::Kind::COMMAND, entry->value, entry->place});
    }
    machine.two_pass = ini.text(ini_key("HAL", "TWOPASS"));
    machine.shutdown_file = ini.text(ini_key("HAL", "SHUTDOWN"));
    for (const ini::IniEntry *entry : ini.list(ini_key("APPLICATIONS", "APP"))) {
        machine.applications.push_back(entry->value);
    }
    machine.applications_delay_s = ini.real(ini_key("APPLICATIONS", "DELAY"));
    machine.has_halui = !ini.text(ini_key("HAL", "HALUI")).empty();
}

void read_interpreter(IniReader &ini, MachineConfig &machine) {
    const IniKey &file = gcode::ini_key("RS274NGC", "PARAMETER_FILE");
    const std::string parameters = ini.text(file);
    machine.task.parameter_file = parameters.empty() ? "" : ini.file().resolve_path(parameters);
    std::error_code error;
    if (!parameters.empty() && std::filesystem::file_size(machine.task.parameter_file, error) == 0 &&
        !error) {
        ini.sink().warning("the parameter file '" + machine.task.parameter_file +
                               "' is empty: all offsets and parameters begin at 0",
                           ini.find(file)->place);
    }
    if (parameters.empty()) {
        ini.sink().warning(
            "[RS274NGC]PARAMETER_FILE is missing: offsets and parameters are not kept after a run",
            ini.file().place_of_section("RS274NGC"));
    }
    const std::string journal = ini.text(ini_key("TASK", "JOURNAL_FILE"));
    if (journal.empty() && !parameters.empty()) {
        machine.journal_file = machine.task.parameter_file + ".journal";
    } else if (!journal.empty() && journal != "none") {
        machine.journal_file = ini.file().resolve_path(journal);
    }
    machine.task.interpreter = gcode::settings_from_ini(ini);
    machine.task.interpreter.start_tolerance_mm = START_TOLERANCE_MM;
    const auto fastest = static_cast<std::uint16_t>(Parameter::TRAJ_MAX_VELOCITY);
    for (const motion::SetParameter &parameter : machine.parameters) {
        if (parameter.parameter == fastest && std::isfinite(parameter.value)) {
            constexpr double MM_PER_INCH = 25.4;
            machine.task.interpreter.max_velocity_mm_s =
                parameter.value * (machine.metric ? 1.0 : MM_PER_INCH);
        }
    }
}

}  // namespace

motion::FoldedLimits MachineConfig::limits() const {
    motion::AxisMap map = axis_map;
    map.kind = isTrivial ? motion::AxisMap::Kind::JOINTS_ARE_AXES : motion::AxisMap::Kind::PLANNED;
    return motion::fold_limits(motion::settings_of(parameters), map, motion::ALL_HOMED);
}

MachineConfig read_machine_config(ini::IniReader &reader) {
    MachineConfig machine;
    reader.declare(all_ini_keys());
    check_form(reader);
    read_names(reader, machine);
    read_coordinates(reader, machine);
    read_first_place(reader, machine);
    read_kinematics(reader, machine);
    read_trajectory(reader, machine);
    read_joints(reader, machine);
    read_axes(reader, machine);
    read_periods(reader, machine);
    read_hal(reader, machine);
    read_interpreter(reader, machine);
    read_io(reader, machine);
    read_panel(reader, machine);
    constexpr double MM_PER_INCH = 25.4;
    machine.parameters.push_back(
        {static_cast<std::uint16_t>(Parameter::TRAJ_MM_PER_UNIT), 0, machine.metric ? 1.0 : MM_PER_INCH});
    machine.task.machine_units = machine.metric ? gcode::LengthUnits::MM : gcode::LengthUnits::INCH;
    machine.task.axis_mask = machine.axis_mask;
    machine.task.num_joints = machine.num_joints;
    machine.task.num_spindles = machine.num_spindles;
    messages::SettingsStatus &shown = machine.task.shown;
    shown.linear_units = machine.metric ? 1.0 : 1.0 / MM_PER_INCH;
    shown.cycle_time_s = static_cast<double>(machine.servo_period_ns) / 1e9;
    shown.debug = static_cast<std::uint32_t>(reader.integer(ini::row_of(gcode::INI_KEYS, "EMC", "DEBUG")));
    shown.kinematics = machine.kinematics_kind();
    shown.joints.fill({shown.linear_units, 0, 1, 1, messages::JointKind::LINEAR});
    machine.task.isHomingForced = !reader.boolean(ini_key(Parameter::TRAJ_NO_FORCE_HOMING));
    return machine;
}

}  // namespace mw::machine
