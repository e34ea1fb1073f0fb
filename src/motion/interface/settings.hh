// SPDX-License-Identifier: GPL-2.0-or-later
// The values of every setting of motion/interface/parameters.hh, for every joint, axis and spindle.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include "base/limits.hh"
#include "motion/interface/parameters.hh"
#include "motion/interface/status.hh"

namespace mw::motion {

class Settings {
  public:
    static constexpr int MAX_INDEX = MAX_JOINTS;

    Settings() noexcept {
        for (const ParameterInfo &info : PARAMETERS) {
            values_[static_cast<std::size_t>(info.parameter)].fill(info.preset);
        }
    }
    double get(Parameter p, int index = 0) const noexcept {
        return values_[static_cast<std::size_t>(p)][static_cast<std::size_t>(index)];
    }
    /// Above 0; changes with each change of a setting.
    std::uint32_t version() const noexcept { return version_; }
    bool isSet(Parameter p, int index = 0) const noexcept { return get(p, index) != 0.0; }

    /// Returns NONE if the value was set, otherwise the reason for rejecting it.
    Reason set(const SetParameter &c, int num_joints, int num_spindles) noexcept {
        if (c.parameter >= static_cast<std::uint16_t>(Parameter::COUNT)) {
            return Reason::NO_SUCH_PARAMETER;
        }
        const ParameterInfo &info = PARAMETERS[c.parameter];
        if (std::isnan(c.value)) {
            return Reason::NOT_A_NUMBER;
        }
        if (c.value < info.lowest || c.value > info.highest) {
            return Reason::OUT_OF_RANGE;
        }
        int count = 1;
        Reason reason = Reason::NO_SUCH_PARAMETER;
        if (info.scope == ParameterScope::JOINT) {
            count = num_joints;
            reason = Reason::NO_SUCH_JOINT;
        } else if (info.scope == ParameterScope::AXIS) {
            count = MAX_AXES;
            reason = Reason::NO_SUCH_AXIS;
        } else if (info.scope == ParameterScope::SPINDLE) {
            count = num_spindles;
            reason = Reason::NO_SUCH_SPINDLE;
        }
        if (c.index < 0 || c.index >= count) {
            return reason;
        }
        values_[c.parameter][static_cast<std::size_t>(c.index)] = c.value;
        version_ = version_ == UINT32_MAX ? 1 : version_ + 1;
        return Reason::NONE;
    }

  private:
    std::array<std::array<double, MAX_INDEX>, static_cast<std::size_t>(Parameter::COUNT)> values_{};
    std::uint32_t version_ = 1;
};

/// Defaults, overwritten by `parameters`; values out of range are ignored.
inline Settings settings_of(std::span<const SetParameter> parameters) noexcept {
    Settings settings;
    for (const SetParameter &p : parameters) {
        settings.set(p, MAX_JOINTS, MAX_SPINDLES);
    }
    return settings;
}

}  // namespace mw::motion
