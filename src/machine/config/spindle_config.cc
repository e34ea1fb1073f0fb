// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/config/spindle_config.hh"

#include <algorithm>

#include "machine/config/ini_keys.hh"
#include "motion/interface/parameters.hh"

namespace mw::machine {
namespace {

using ini::IniKey;
using motion::Parameter;

/// The limits of one spindle in the parameters of a machine.
struct Limits {
    MachineConfig &machine;
    int spindle;

    motion::SetParameter *find(Parameter parameter) {
        const auto found =
            std::find_if(machine.parameters.begin(), machine.parameters.end(), [&](const auto &one) {
                return one.parameter == static_cast<std::uint16_t>(parameter) && one.index == spindle;
            });
        return found == machine.parameters.end() ? nullptr : &*found;
    }
    void set(Parameter parameter, double value) {
        if (motion::SetParameter *const present = find(parameter)) {
            present->value = value;
            return;
        }
        machine.parameters.push_back(
            {static_cast<std::uint16_t>(parameter), static_cast<std::int16_t>(spindle), value});
    }
};

/// If two limits of one direction contradict each other, the narrower limit is used, because it is safe.
template <class Narrower>
void read_limit(ini::IniReader &ini, Limits limits, const IniKey &both, Parameter forward, Parameter reverse,
                Narrower narrower) {
    const std::string section = "SPINDLE_" + std::to_string(limits.spindle);
    const motion::SetParameter *const own = limits.find(forward);
    if (const ini::IniEntry *const entry = ini.find(both, section)) {
        const double value = ini.real(both, section);
        if (own != nullptr && own->value != value) {
            ini.sink().warning('[' + section + ']' + std::string(both.name) + " and " +
                                   std::string(ini_key(forward).name) +
                                   " limit the same direction. The narrower limit is used.",
                               entry->place, "Remove one of the two limits.");
        }
        limits.set(forward, own != nullptr ? narrower(own->value, value) : value);
    }
    const motion::SetParameter *const most = limits.find(forward);
    if (most != nullptr && limits.find(reverse) == nullptr) {
        limits.set(reverse, most->value);
    }
}

}  // namespace

void read_spindle_limits(ini::IniReader &ini, int spindle, MachineConfig &machine) {
    const Limits limits{machine, spindle};
    read_limit(ini, limits, ini_key("SPINDLE_*", "MAX_VELOCITY"), Parameter::SPINDLE_MAX_FORWARD,
               Parameter::SPINDLE_MAX_REVERSE, [](double a, double b) { return std::min(a, b); });
    read_limit(ini, limits, ini_key("SPINDLE_*", "MIN_VELOCITY"), Parameter::SPINDLE_MIN_FORWARD,
               Parameter::SPINDLE_MIN_REVERSE, [](double a, double b) { return std::max(a, b); });
}

}  // namespace mw::machine
